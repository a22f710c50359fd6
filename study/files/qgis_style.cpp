#include "study/files/qgis_style.h"

#include <fmt/format.h>

#include "base/text/xml_text.h"

namespace emscape::study {
namespace {

/// @param options  the layer's settings  @param color_property  setting that the field "color" provides;
/// empty: none
std::string symbol(const std::string& name, const char* type, const char* layer, double alpha,
                   const std::string& options, const std::string& color_property) {
  std::string data_defined;
  if (!color_property.empty()) {
    data_defined = fmt::format(
        R"(<data_defined_properties><Option type="Map"><Option name="name" value="" type="QString"/>)"
        R"(<Option name="properties" type="Map"><Option name="{}" type="Map"><Option name="active" value="true" type="bool"/>)"
        R"(<Option name="field" value="color" type="QString"/><Option name="type" value="2" type="int"/></Option></Option>)"
        R"(<Option name="type" value="collection" type="QString"/></Option></data_defined_properties>)",
        color_property);
  }
  return fmt::format(
      R"(<symbol name="{}" type="{}" alpha="{}" clip_to_extent="1" force_rhr="0">)"
      R"(<layer class="{}" enabled="1" locked="0" pass="0"><Option type="Map">{}</Option>{}</layer></symbol>)",
      name, type, alpha, layer, options, data_defined);
}

std::string option(const char* name, const char* value) {
  return fmt::format(R"(<Option name="{}" value="{}" type="QString"/>)", name, value);
}

/// @param symbol_of  returns the symbol of a name
template <class SymbolOf>
std::string ruleRenderer(const std::vector<StyleRule>& rules, const SymbolOf& symbol_of) {
  std::string list, symbols;
  for (std::size_t n = 0; n < rules.size(); ++n) {
    list += fmt::format(R"(<rule key="{{rule{0}}}" symbol="{0}" label="{1}" filter="{2}"{3}/>)", n,
                        escapedXml(rules[n].label), escapedXml(rules[n].filter),
                        rules[n].is_on ? "" : R"( checkstate="0")");
    symbols += symbol_of(std::to_string(n));
  }
  return fmt::format(
      R"(<renderer-v2 type="RuleRenderer" symbollevels="0" enableorderby="0" forceraster="0"><rules key="{{root}}">{}</rules>)"
      R"(<symbols>{}</symbols></renderer-v2>)",
      list, symbols);
}

std::string singleRenderer(const std::string& symbol) {
  return fmt::format(
      R"(<renderer-v2 type="singleSymbol" symbollevels="0" enableorderby="0" forceraster="0"><symbols>{}</symbols></renderer-v2>)",
      symbol);
}

/// Labels of a field, with a white rim. @param placement  QGIS's number: 0 around a point, 2 along a line
std::string labels(const char* field, int placement) {
  return fmt::format(
      R"(<labeling type="simple"><settings calloutType="simple"><text-style fieldName="{}" fontSize="8" textColor="30,30,30,255">)"
      R"(<text-buffer bufferDraw="1" bufferSize="0.8" bufferColor="255,255,255,255"/></text-style>)"
      R"(<placement placement="{}" dist="1.5"/><rendering obstacle="0"/></settings></labeling>)",
      field, placement);
}

std::string styleOf(const std::string& content, bool has_labels, bool is_temporal) {
  const char* const temporal =
      is_temporal
          ? R"(<temporal enabled="1" mode="2" startField="time" endField="time_end" durationField="" durationUnit="min" )"
            R"(fixedDuration="0" accumulate="0" startExpression="" endExpression=""><fixedRange><start></start><end></end></fixedRange></temporal>)"
          : "";
  return fmt::format(
      "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>"
      R"(<qgis version="3.22.0" styleCategories="AllStyleCategories" labelsEnabled="{}">{}{}</qgis>)",
      has_labels ? 1 : 0, temporal, content);
}

}  // namespace

std::string bandStyle(const std::vector<StyleRule>& rules) {
  const auto symbolOf = [](const std::string& name) {
    return symbol(
        name, "fill", "SimpleFill", 0.7,
        option("color", "128,128,128,255") + option("style", "solid") + option("outline_style", "no"),
        "fillColor");
  };
  return styleOf(ruleRenderer(rules, symbolOf), false, true);
}

std::string contourStyle(const std::vector<StyleRule>& rules) {
  const auto symbolOf = [](const std::string& name) {
    return symbol(
        name, "line", "SimpleLine", 1,
        option("line_color", "40,40,40,255") + option("line_width", "0.3") + option("line_width_unit", "MM"),
        "");
  };
  return styleOf(ruleRenderer(rules, symbolOf) + labels("level", 2), true, true);
}

std::string emitterStyle() {
  return styleOf(singleRenderer(symbol("0", "marker", "SimpleMarker", 1,
                                       option("name", "circle") + option("color", "128,128,128,255") +
                                           option("outline_color", "25,30,38,255") + option("size", "3"),
                                       "fillColor")) +
                     labels("name", 0),
                 true, true);
}

std::string siteStyle() {
  return styleOf(singleRenderer(symbol("0", "marker", "SimpleMarker", 1,
                                       option("name", "square") + option("color", "255,255,255,255") +
                                           option("outline_color", "25,30,38,255") + option("size", "2"),
                                       "")) +
                     labels("name", 0),
                 false, true);
}

std::string trackStyle() {
  return styleOf(singleRenderer(symbol("0", "line", "SimpleLine", 1,
                                       option("line_color", "60,60,60,255") + option("line_width", "0.5") +
                                           option("line_style", "dash"),
                                       "")) +
                     labels("platform", 2),
                 true, false);
}

std::string expressionText(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

}  // namespace emscape::study
