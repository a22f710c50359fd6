/// A shared library that is loaded when a function of it is first called.
#pragma once

#include <atomic>
#include <string>
#include <tuple>
#include <vector>

namespace emscape {

class LoadedLibrary {
 public:
  /// Loads the first of the files that can be loaded; it stays loaded until the process ends.
  /// @param files  names, which the dynamic linker looks for
  /// @param title,remedy  for the error: what the library is, and the packages that hold it
  /// @throws Error (other) that names them, with the linker's reason
  LoadedLibrary(const std::vector<std::string>& files, const std::string& title, const std::string& remedy);

  /// @throws Error (other) naming the function and the library's file
  void* function(const char* name) const;
  /// The same for a function that the library or one that it needs may have; null if none has.
  void* functionIfAny(const char* name) const;

 private:
  std::string file_;
  void* handle_ = nullptr;
};

/// A C function of the library that kLibrary() returns; it is looked up at the first call. Threads may share
/// it.
template <const LoadedLibrary& (*kLibrary)(), class Function>
class LoadedFunction;

template <const LoadedLibrary& (*kLibrary)(), class Result, class... Arguments>
class LoadedFunction<kLibrary, Result(Arguments...)> {
 public:
  using FirstArgument = std::tuple_element_t<0, std::tuple<Arguments..., void>>;

  constexpr explicit LoadedFunction(const char* name) : name_(name) {}

  Result operator()(Arguments... arguments) const { return pointer()(arguments...); }

 protected:
  template <class Function = Result(Arguments...)>
  Function* pointer() const {
    void* address = address_.load(std::memory_order_acquire);
    if (address == nullptr) address_.store(address = kLibrary().function(name_), std::memory_order_release);
    return reinterpret_cast<Function*>(address);
  }

 private:
  const char* name_;
  mutable std::atomic<void*> address_{nullptr};
};

/// A function with further arguments, as of printf.
template <const LoadedLibrary& (*kLibrary)(), class Result, class... Arguments>
class LoadedFunction<kLibrary, Result(Arguments..., ...)>
    : private LoadedFunction<kLibrary, Result(Arguments...)> {
 public:
  using LoadedFunction<kLibrary, Result(Arguments...)>::LoadedFunction;

  template <class... Further>
  Result operator()(Arguments... arguments, Further... further) const {
    return this->template pointer<Result(Arguments..., ...)>()(arguments..., further...);
  }
};

}  // namespace emscape
