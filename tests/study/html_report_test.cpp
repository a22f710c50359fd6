#include "study/report/html_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace emscape::study {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(HtmlReport, HoldsItsPartsEscapedAndInOrder) {
  HtmlReport report("A < B", "two radars & a jammer");
  report.section("Areas");
  report.table({{"height", "won (km2)"}, {{"150 m", "12.5"}, {"<none>", "0"}}, "Areas won"});
  report.section("Inputs");
  report.facts({{"scenario", "a \"b\""}});
  const std::string html = report.html();
  EXPECT_THAT(html, HasSubstr("<title>A &lt; B</title>"));
  EXPECT_THAT(html, HasSubstr("two radars &amp; a jammer"));
  EXPECT_THAT(html, HasSubstr("<td class=\"number\">12.5</td>"));
  EXPECT_THAT(html, HasSubstr("<th>height</th><th class=\"number\">won (km2)</th>"));
  EXPECT_THAT(html, HasSubstr("<td>&lt;none&gt;</td>"));
  EXPECT_THAT(html, HasSubstr("a &quot;b&quot;"));
  EXPECT_THAT(html, HasSubstr("<a href=\"#section2\">Inputs</a>"));
  EXPECT_LT(html.find("<h2 id=\"section1\">Areas"), html.find("<h2 id=\"section2\">Inputs"));
}

TEST(HtmlReport, SummaryAndWarningsAreAboveTheContents) {
  HtmlReport report("maps", "");
  report.section("Areas");
  report.summary("The radar detects a target on 62 % of the area.");
  report.warnings({"first < second", "third"});
  const std::string html = report.html();
  EXPECT_THAT(html, HasSubstr("<div class=\"summary\">\n<p>The radar detects"));
  EXPECT_THAT(html, HasSubstr("<div class=\"warnings\">\n<p>⚠ 2 warnings</p>"));
  EXPECT_THAT(html, HasSubstr("<li>first &lt; second</li>"));
  EXPECT_LT(html.find("class=\"summary\""), html.find("class=\"warnings\""));
  EXPECT_LT(html.find("class=\"warnings\""), html.find("<a href=\"#section1\">"));
  EXPECT_THAT(HtmlReport("maps", "").html(), Not(HasSubstr("<div"))) << "no empty boxes";
}

TEST(HtmlReport, InlinesPicturesAndHasNoExternalReferences) {
  HtmlReport report("maps", "");
  render::Image8 image;
  image.size = {2, 1};
  image.rgba = {255, 0, 0, 255, 0, 255, 0, 255};
  report.picture(image, "two pixels");
  report.drawing("<?xml version=\"1.0\"?>\n<svg width=\"1\"></svg>", "a drawing");
  const std::string html = report.html();
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,iVBORw0KGgo"));  // the signature of PNG
  EXPECT_THAT(
      html,
      HasSubstr(
          "src=\"data:image/svg+xml;base64,PD94bWwgdmVyc2lvbj0iMS4wIj8+Cjxzdmcgd2lkdGg9IjEiPjwvc3ZnPg==\""));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("<?xml")));
}

}  // namespace
}  // namespace emscape::study
