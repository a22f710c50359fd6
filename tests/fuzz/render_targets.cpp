// Texts that describe how a picture is drawn.
#include "emscape/render/picture/image.h"
#include "emscape/render/scene/camera.h"
#include "emscape/render/scene/cut_plane.h"
#include "emscape/render/transfer/transfer_function.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/files.h"

namespace emscape::test {
namespace {

const FuzzTargetsAdded added({
    {"transfer", "input.json",
     [](const std::filesystem::path& file, const std::string&) {
       volume::VolumeInfo info;
       info.quantity = "power_density_dbwm2";
       info.unit = "dBW/m2";
       info.range_min = -120;
       info.range_max = 0;
       const render::TransferFunction function = render::readTransferFunction(file, info);
       render::parseTransferFunction(render::transferFunctionText(function), "again.json", info);
     },
     [] {
       std::vector<std::string> seeds;
       for (const char* name : {"paper", "power_density_dbwm2", "relative_viridis", "slice_viridis"})
         seeds.push_back(readFile(sourceFile(std::string("scenarios/transfer/") + name + ".json")));
       return seeds;
     }},
    {"camera", "", [](const std::filesystem::path&, const std::string& text) { render::parseCamera(text); },
     [] {
       return std::vector<std::string>{
           "orbit:azimuth_deg=225,elevation_deg=30,distance=1.8,fov_deg=35,projection=perspective",
           "orbit:target_x_m=1,target_y_m=2,target_z_m=3,projection=orthographic",
           "lookat:eye_x_m=1,eye_y_m=2,eye_z_m=3,target_x_m=4,target_y_m=5,target_z_m=6"};
     }},
    {"plane", "", [](const std::filesystem::path&, const std::string& text) { render::parseCutPlane(text); },
     [] {
       return std::vector<std::string>{"horizontal:altitude_m=500,keep=below",
                                       "vertical:bearing_deg=30,x_m=1,y_m=-2,offset_m=3,keep=left"};
     }},
    {"image_size", "",
     [](const std::filesystem::path&, const std::string& text) { render::parseImageSize(text); },
     [] { return std::vector<std::string>{"1280x720"}; }},
});

}  // namespace
}  // namespace emscape::test
