#include <fmt/format.h>

#include "base/text/xml_text.h"
#include "interop/exporting/writers.h"
#include "interop/importing/nodes.h"
#include "recording/common/dates.h"

namespace emscape::interop {
namespace {

std::string placeText(const PoseSample& pose, const char* separator) {
  return decimalText(pose.longitude_deg, 8) + separator + decimalText(pose.latitude_deg, 8) + separator +
         decimalText(pose.height_msl_m, 2);
}

}  // namespace

long long writeKml(const ExportJob& job, const TextSink& sink, std::vector<ExportedRow>& rows) {
  const scenario::Scenario& scenario = job.scenario;
  const double epoch_s = epochOf_s(scenario);
  long long records = 0;
  sink(
      fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
                  "xmlns:gx=\"http://www.google.com/kml/ext/2.2\">\n<Document><name>{}</name>\n",
                  escapedXml(scenario.name)));
  for (std::size_t i = 0; i < scenario.platforms.size(); ++i) {
    const scenario::Platform& platform = scenario.platforms[i];
    if (job.progress)
      job.progress("writing KML", static_cast<double>(i) / static_cast<double>(scenario.platforms.size()));
    const std::vector<double> times = timesOfPositions(scenario, platform, job.step_s);
    if (times.empty()) continue;  // never present
    std::string description;
    for (const scenario::Emitter& emitter : scenario.emitters) {
      if (static_cast<std::size_t>(emitter.platform) == i)
        description += (description.empty() ? "" : ", ") + emitter.name;
    }
    sink(fmt::format("<Placemark><name>{}</name><description>{}</description>", escapedXml(platform.name),
                     escapedXml(description)));
    if (!platform.moves()) {
      sink("<Point><altitudeMode>absolute</altitudeMode><coordinates>" +
           placeText(poseOf(platform, job.terrain, 0), ",") + "</coordinates></Point></Placemark>\n");
      ++records;
      continue;
    }
    sink("\n<gx:Track><altitudeMode>absolute</altitudeMode>\n");
    for (const double t_s : times) sink("<when>" + utcTextOf(epoch_s + t_s) + "</when>\n");
    for (const double t_s : times)
      sink("<gx:coord>" + placeText(poseOf(platform, job.terrain, t_s), " ") + "</gx:coord>\n");
    for (const double t_s : times) {
      const PoseSample pose = poseOf(platform, job.terrain, t_s);
      sink(fmt::format("<gx:angles>{} {} {}</gx:angles>\n", decimalText(pose.heading_deg, 3),
                       decimalText(pose.pitch_deg, 3), decimalText(pose.roll_deg, 3)));
    }
    sink("</gx:Track></Placemark>\n");
    records += static_cast<long long>(times.size());
  }
  sink("</Document></kml>\n");
  addRowsOfPlatforms(scenario, rows);
  return records;
}

}  // namespace emscape::interop
