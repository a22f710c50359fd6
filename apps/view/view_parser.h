/// The parser of emscape-view's command line, for generating its documentation.
#pragma once

#include <memory>

namespace CLI {
class App;
}

namespace emscape::view {

std::shared_ptr<const CLI::App> viewParser();

}  // namespace emscape::view
