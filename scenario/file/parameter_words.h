/// Words for people: names of keys, and what choices mean.
#pragma once

#include <string>

namespace emscape::scenario {

/// How a form shows a key.
struct KeyWords {
  std::string name;        ///< "height above ground"
  bool is_expert = false;  ///< rarely changed
};

/// @param stem  the key without its unit's suffix, for keys without words of their own
KeyWords wordsOf(const std::string& key, const std::string& stem);

/// A title of a choice and, of propagation models, a word on the cost: "ITU-R P.1812-8: terrestrial, by share
/// of time and places; slow". The choice itself if there is no title.
std::string titleOf(const std::string& key, const std::string& choice);

/// A message with the names of values in place of the keys in quotation marks.
std::string inWords(const std::string& message);

}  // namespace emscape::scenario
