/// The extension module emscape._emscape: the public C++ interface as emscape/*.py uses it.
#include "python/extension/module.h"

NB_MODULE(_emscape, module) {
  using namespace emscape::python;
  // Arrays that other libraries hold at exit, such as PyVista's and Dask's, are no leaks.
  nb::set_leak_warnings(false);
  module.doc() = "Compiled part of the package emscape. Use the names of the package.";
  bindErrors(module);
  bindScenario(module);
  bindField(module);
  bindCoverage(module);
  bindPicture(module);
  bindStudies(module);
}
