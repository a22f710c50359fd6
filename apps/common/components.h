/// Third-party components of the programs: versions and licences, as text and as a bill of materials.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace emscape::app {

enum class Linkage { shared, static_, headers };

/// A third-party component that is linked or compiled in.
struct Component {
  const char* name;
  const char* version;  ///< at build time; a shared library of another version may be loaded
  const char* licence;  ///< SPDX expression
  Linkage linkage;
  const char* library;  ///< beginning of the library's file name; empty: header-only
};

/// Version, compiler, CUDA, instruction sets and available GPU.
std::string versionText();

/// The licence of Emscape, and one line per component: name, version, licence, linkage.
std::string licencesText();

/// The components as a CycloneDX 1.5 bill of materials, without time or serial number: equal builds give
/// equal bytes.
nlohmann::ordered_json billOfMaterials();

}  // namespace emscape::app
