#include "base/loaded_library.h"

#include "tests/support/errors.h"

namespace emscape {
namespace {

const LoadedLibrary& mathematics() {
  static const LoadedLibrary kLibrary({"libm.so.6"}, "the mathematical library", "install libc6");
  return kLibrary;
}
const LoadedFunction<&mathematics, double(double)> cosine{"cos"}, missing{"no_such_function"};

TEST(LoadedLibrary, FunctionIsCalledByItsName) {
  EXPECT_EQ(cosine(0.0), 1.0);
  EXPECT_EQ(cosine(0.0), 1.0);
}

TEST(LoadedLibrary, FirstFileThatLoadsIsTaken) {
  const LoadedLibrary library({"libnone.so.7", "libm.so.6"}, "the mathematical library", "install libc6");
  EXPECT_NE(library.function("sin"), nullptr);
}

TEST(LoadedLibrary, MissingLibraryIsNamedWithItsPackage) {
  const Error error = test::thrownBy([] {
    LoadedLibrary({"libnone.so.7", "libnone.so.6"}, "the library None", "install the package libnone7");
  });
  EXPECT_EQ(error.code(), ErrorCode::other);
  EXPECT_EQ(error.message(),
            "cannot load the library None (libnone.so.7: cannot open shared object file: No such file or "
            "directory); install the package libnone7");
}

TEST(LoadedLibrary, MissingFunctionIsNamedWithItsLibrary) {
  const Error error = test::thrownBy([] { missing(0.0); });
  EXPECT_EQ(error.message(), "libm.so.6 has no function no_such_function: it is of an older version");
}

}  // namespace
}  // namespace emscape
