#include "volume/vtk/vti.h"

#include <cmath>

#include "emscape/volume/format/file.h"
#include "emscape/volume/statistics.h"
#include "tests/volume/sample_volumes.h"

namespace emscape::volume {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace test;

/// The categorical sample on the field sample's grid.
DenseVolume emitterVolume() {
  DenseVolume volume = categoricalVolume(fieldVolume().grid.dims);
  volume.grid = fieldVolume().grid;
  return volume;
}

TEST(Vti, RoundTripIsExact) {
  TemporaryFolder folder;
  for (const DenseVolume& volume : {fieldVolume(), categoricalVolume(), plainVolume()}) {
    writeVti(folder / "a.vti", {&volume});
    expectSame(readVti(folder / "a.vti"), volume);
  }
}

TEST(Vti, HoldsSeveralQuantitiesOnOneGrid) {
  TemporaryFolder folder;
  const DenseVolume power = fieldVolume();
  for (const bool same_mask : {true, false}) {
    DenseVolume emitter = emitterVolume();
    if (!same_mask) emitter.first_valid_k.clear();
    writeVti(folder / "a.vti", {&power, &emitter});
    expectSame(readVti(folder / "a.vti"), power);
    expectSame(readVti(folder / "a.vti", "dominant_emitter"), emitter);
    const std::vector<DenseVolume> descriptions = describeVti(folder / "a.vti");
    ASSERT_EQ(descriptions.size(), 2U);
    expectSameInfo(descriptions[1], emitter);
  }
  EXPECT_THAT(errorOf([&] { readVti(folder / "a.vti", "snr_db"); }),
              HasSubstr("no array \"snr_db\"; the file holds power_density_dbwm2, dominant_emitter"));
  const DenseVolume other = plainVolume();
  EXPECT_THAT(errorOf([&] {
                writeVti(folder / "b.vti", {&power, &other});
              }),
              HasSubstr("are on different grids"));
}

TEST(Vti, QuantitiesMayHaveNamesThatXmlMustEscape) {
  TemporaryFolder folder;
  DenseVolume volume = plainVolume();
  volume.info.quantity = "power:radar <\"A\"> & co";
  writeVti(folder / "a.vti", {&volume});
  expectSame(readVti(folder / "a.vti", volume.info.quantity), volume);
}

TEST(Vti, CharactersThatXmlDoesNotAllowAreReplaced) {
  TemporaryFolder folder;
  DenseVolume volume = plainVolume();
  volume.info.quantity = "power:\x1B[31mred\xEF\xBF\xBF";
  writeVti(folder / "a.vti", {&volume});
  setStoredRange(folder / "a.vti", {{volume.info.quantity, -2, 3}});
  const DenseVolume read = readVti(folder / "a.vti");
  EXPECT_EQ(read.info.quantity, volume.info.quantity) << "of the description, whose texts are numbers";
  const std::string name = "Name=\"power:\xEF\xBF\xBD[31mred\xEF\xBF\xBD\"";
  EXPECT_THAT(readWholeText(folder / "a.vti", 100000), HasSubstr(name));
  EXPECT_EQ(read.info.range_min, -2);
}

TEST(Vti, SurvivesDamage) {
  TemporaryFolder folder;
  const DenseVolume volume = fieldVolume({5, 5, 6});
  writeVti(folder / "a.vti", {&volume});
  survivesDamage(folder / "a.vti", [&] { readVti(folder / "a.vti"); });
}

std::string vti(const std::string& attributes, const std::string& array, const std::string& tail) {
  return "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" " + attributes +
         "><ImageData WholeExtent=\"2 3 0 1 0 0\" Origin=\"10 20 30\" Spacing=\"1 2 3\">"
         "<Piece Extent=\"2 3 0 1 0 0\"><PointData><DataArray Name=\"d\" " +
         array + "</DataArray></PointData></Piece></ImageData>" + tail + "</VTKFile>";
}

DenseVolume readText(const std::string& text) {
  TemporaryFolder folder;
  writeBytes(folder / "a.vti", {text.begin(), text.end()});
  return readVti(folder / "a.vti");
}

TEST(ForeignVti, MayBeInlineBase64) {
  // 4 bytes: 4 0 0 0 | 1 2 3 250
  const DenseVolume volume = readText(vti("", "type=\"UInt8\" format=\"binary\">\n BAAAAAECA/o=\n", ""));
  EXPECT_EQ(volume.values, (UnsetVector<float>{1, 2, 3, 250}));
  EXPECT_EQ(volume.grid.dims, (Dims{2, 2, 1}));
  EXPECT_EQ(volume.grid.first_center_m, (Vec3d{12, 20, 30}));
  EXPECT_EQ(volume.info.quantity, "d");
  EXPECT_FALSE(volume.grid.georeferenced);
}

TEST(ForeignVti, ZeroIsAValue) {
  const DenseVolume volume = readText(vti("", "type=\"UInt8\" format=\"binary\">BAAAAAAAAAE=", ""));
  EXPECT_EQ(volume.values, (UnsetVector<float>{0, 0, 0, 1}));
  EXPECT_EQ(volume.info.range_min, 0);
  EXPECT_EQ(volume.info.range_max, 1);
  EXPECT_EQ(statisticsOf(volume).at_floor, 0);
}

TEST(ForeignVti, MayBeAppendedBase64WithPaddingAfterTheHeader) {
  const DenseVolume volume =
      readText(vti("", "type=\"UInt8\" format=\"appended\" offset=\"0\">",
                   "<AppendedData encoding=\"base64\">_BAAAAA==AQID+g==</AppendedData>"));
  EXPECT_EQ(volume.values, (UnsetVector<float>{1, 2, 3, 250}));
}

TEST(ForeignVti, MayBeCompressedWithZlib) {
  // One block of 4 bytes; then blocks of 3 bytes and 1.
  for (const char* blocks : {"AQAAAAQAAAAAAAAADAAAAA==eJxjZGL+BQABDgEB",
                             "AgAAAAMAAAABAAAACwAAAAkAAAA=eJxjZGIGAAANAAd4nPsFAAD7APs="}) {
    const DenseVolume volume = readText(vti("compressor=\"vtkZLibDataCompressor\"",
                                            std::string("type=\"UInt8\" format=\"binary\">") + blocks, ""));
    EXPECT_EQ(volume.values, (UnsetVector<float>{1, 2, 3, 250}));
  }
}

TEST(ForeignVti, MayBeText) {
  const DenseVolume volume =
      readText(vti("", "type=\"Float32\" format=\"ascii\">\n  1 -2.5e1\r\n\tnan 1e-3\n", ""));
  ASSERT_EQ(volume.values.size(), 4U);
  EXPECT_EQ(volume.values[1], -25);
  EXPECT_TRUE(std::isnan(volume.values[2]));
  EXPECT_EQ(volume.values[3], 1e-3F);
  const auto refusal = [](const std::string& array) {
    return errorOf([&] { readText(vti("", array, "")); }, ErrorCode::bad_input);
  };
  EXPECT_THAT(refusal("type=\"UInt8\" format=\"ascii\">1 2 300 4"),
              HasSubstr("array d: value 2: \"300\": must be a number of type UInt8"));
  EXPECT_THAT(refusal("type=\"Float32\" format=\"ascii\">1 2 3 1e40"), HasSubstr("value 3: \"1e40\""));
  EXPECT_THAT(refusal("type=\"Float32\" format=\"ascii\">1 2,5 3 4"), HasSubstr("value 1: \"2,5\""));
  EXPECT_THAT(refusal("type=\"UInt8\" format=\"ascii\">1 2 3"),
              HasSubstr("array d: expected 4 values, found 3"));
  EXPECT_THAT(refusal("type=\"UInt8\" format=\"ascii\">1 2 3 4 5"), HasSubstr("array d: more than 4 values"));
}

TEST(ForeignVti, MayStateItsTime) {
  const auto readWith = [](const std::string& time) {
    std::string text = vti("", "type=\"UInt8\" format=\"ascii\">1 2 3 4", "");
    text.insert(text.find("<Piece"), "<FieldData><DataArray Name=\"TimeValue\" type=\"Float64\" " + time +
                                         "</DataArray></FieldData>");
    return readText(text).info;
  };
  EXPECT_EQ(readWith("format=\"ascii\">\n 2.5\n").time_s, 2.5);
  EXPECT_EQ(readWith("NumberOfTuples=\"1\" format=\"binary\">CAAAAAAAAAAAAARA").time_s, 2.5);
  EXPECT_TRUE(readWith("format=\"ascii\">0").has_time);
  EXPECT_FALSE(readWith("format=\"ascii\">nan").has_time);
  EXPECT_EQ(readWith("format=\"ascii\">+2.5").time_s, 2.5);
  EXPECT_FALSE(readText(vti("", "type=\"UInt8\" format=\"ascii\">1 2 3 4", "")).info.has_time);
  EXPECT_THAT(errorOf([&] { readWith("format=\"ascii\">1e99"); }),
              HasSubstr("a.vti: TimeValue 1e+99 s is outside the allowed range -1e+12 to 1e+12 s"));
}

TEST(ForeignVti, MayStateItsTimeInAnyType) {
  const auto timeOf = [](const std::string& type, const std::string& binary) {
    std::string text = vti("", "type=\"UInt8\" format=\"ascii\">1 2 3 4", "");
    text.insert(text.find("<Piece"), "<FieldData><DataArray Name=\"TimeValue\" type=\"" + type +
                                         "\" NumberOfTuples=\"1\" format=\"binary\">" + binary +
                                         "</DataArray></FieldData>");
    const VolumeInfo info = readText(text).info;
    EXPECT_TRUE(info.has_time) << type;
    return info.time_s;
  };
  EXPECT_EQ(timeOf("Float32", "BAAAAAAAIEA="), 2.5);
  EXPECT_EQ(timeOf("Int32", "BAAAAAIAAAA="), 2);
  EXPECT_EQ(timeOf("UInt8", "AQAAAAI="), 2);
  EXPECT_EQ(timeOf("Int64", "CAAAAP7/////////"), -2);
}

/// A file with our metadata of the array d, as VTK writes them again.
std::string described(const std::string& attributes, const std::string& metadata) {
  std::string text = vti(attributes, "type=\"UInt8\" format=\"ascii\">1 2 3 4", "");
  return text.insert(text.find("<Piece"),
                     "<FieldData><Array type=\"String\" Name=\"emscape:d\" "
                     "NumberOfTuples=\"1\" format=" +
                         metadata + "</Array></FieldData>");
}

/// The same with the metadata as text.
std::string describedByText(const std::string& json) {
  std::string codes;
  for (const char character : json) codes += std::to_string(static_cast<int>(character)) + " ";
  return described("", "\"ascii\">" + codes + "0");
}

// {"quantity":"d","unit":"dB","dims":[2,2,1],"spacing_m":[1,2,3],"first_center_m":[12,20,30],"floor":-9}
TEST(ForeignVti, KeepsOurMetadataInBinaryForm) {
  const std::string plain =
      "ZwAAAHsicXVhbnRpdHkiOiJkIiwidW5pdCI6ImRCIiwiZGltcyI6WzIsMiwxXSwic3BhY2luZ19tIjpbMSwyLDNdLCJmaXJzdF9j"
      "ZW50ZXJfbSI6WzEyLDIwLDMwXSwiZmxvb3IiOi05fQA=";
  const std::string zlib =
      "AQAAAACAAABnAAAAYAAAAA==eJwlikEKgCAQAHvLnjewPOWxb0REqMVCaul2iOjvbXQbZuaG45wjE19gwAHCGYk/7IUdhQJm"
      "aLHFZkQo+2wprlMQ14jT4hbKhSfrI/v8B7kVavW1LaUMpu6e6gVpEh7X";
  const std::string compressed = "compressor=\"vtkZLibDataCompressor\"";
  std::string appended = described("", "\"appended\" offset=\"0\">");
  appended.insert(appended.find("</VTKFile>"),
                  "<AppendedData encoding=\"base64\">_" + plain + "</AppendedData>");
  for (const std::string& text : {described("", "\"binary\">" + plain),
                                  described(compressed, "\"binary\">\n" + zlib + "\n"), appended}) {
    const VolumeInfo info = readText(text).info;
    EXPECT_EQ(info.unit, "dB");
    EXPECT_EQ(info.floor, -9);
  }
  // A length of 2 MiB.
  EXPECT_THAT(errorOf([&] { readText(described("", "\"binary\">AAAgAHsi")); }),
              HasSubstr("array emscape:d: expected at most 1048576 bytes, found 2097152"));
}

TEST(ForeignVti, OnAnotherGridThanOurMetadataStateIsReadAsForeign) {
  const auto read = [](const std::string& grid) {
    DenseVolume volume;
    const std::vector<std::string> messages = messagesOf(
        [&] { volume = readText(describedByText("{\"quantity\":\"p\",\"unit\":\"dB\"," + grid + "}")); });
    EXPECT_EQ(volume.grid.dims, (Dims{2, 2, 1}));
    EXPECT_EQ(volume.info.unit.empty(), !messages.empty());
    EXPECT_EQ(volume.grid.first_center_m, (Vec3d{12, 20, 30})) << grid;
    EXPECT_EQ(volume.info.quantity, messages.empty() ? "p" : "d");
    return messages.empty() ? "" : messages.front();
  };
  EXPECT_EQ(read("\"dims\":[2,2,1],\"spacing_m\":[1,2,3],\"first_center_m\":[12,20,30]"), "");
  EXPECT_THAT(
      read("\"dims\":[2,2,1],\"spacing_m\":[1,2,3],\"first_center_m\":[0,20,30]"),
      HasSubstr("a.vti: array d: the image has another place or spacing than in its metadata, which another "
                "program must have copied; it is read as that program's"));
  EXPECT_THAT(read("\"dims\":[2,2,1],\"spacing_m\":[2,2,3],\"first_center_m\":[12,20,30]"),
              HasSubstr("spacing"));
  EXPECT_THAT(read("\"dims\":[4,2,1],\"spacing_m\":[1,2,3],\"first_center_m\":[12,20,30]"),
              HasSubstr("the image has other dims than in its metadata"));
}

TEST(ForeignVti, ArraysThatCannotBeReadAreLeftOut) {
  std::string text = vti("", "type=\"UInt8\" format=\"ascii\">1 2 3 4", "");
  text.insert(text.find("<DataArray"),
              "<DataArray Name=\"u\" type=\"Float32\" NumberOfComponents=\"3\" "
              "format=\"ascii\">0 0 0 0 0 0 0 0 0 0 0 0</DataArray>");
  text.insert(text.find("</Piece>"), "<CellData><DataArray Name=\"c\" type=\"Float32\"/></CellData>");
  TemporaryFolder folder;
  writeBytes(folder / "a.vti", {text.begin(), text.end()});
  std::vector<DenseVolume> descriptions;
  const auto messages = messagesOf([&] {
    descriptions = describeVti(folder / "a.vti");
    describeVti(folder / "a.vti");
  });
  EXPECT_THAT(
      messages,
      ElementsAre(HasSubstr("a.vti: left out: array u has 3 components; one can be read; cell data c")));
  ASSERT_EQ(descriptions.size(), 1U);
  EXPECT_EQ(descriptions[0].info.quantity, "d");
  EXPECT_EQ(readVti(folder / "a.vti").info.quantity, "d");
  EXPECT_THAT(errorOf([&] { readVti(folder / "a.vti", "u"); }), HasSubstr("array u has 3 components"));
}

TEST(ForeignVti, MayHaveAnArrayWithoutName) {
  std::string text = vti("", "type=\"UInt8\" format=\"ascii\">1 2 3 4", "");
  text.replace(text.find("Name=\"d\""), 8, "Name=\"\"");
  TemporaryFolder folder;
  writeBytes(folder / "a.vti", {text.begin(), text.end()});
  const std::string name = describeVti(folder / "a.vti").at(0).info.quantity;
  EXPECT_EQ(name, "scalars");
  EXPECT_EQ(readVti(folder / "a.vti", name).values[3], 4);
  EXPECT_THAT(errorOf([&] { readVti(folder / "a.vti", "d"); }),
              HasSubstr("no array \"d\"; the file holds scalars"));
}

TEST(ForeignVti, OnOtherAxesIsRefused) {
  const auto textWith = [](const std::string& direction) {
    std::string text = vti("", "type=\"UInt8\" format=\"ascii\">1 2 3 4", "");
    return text.insert(text.find(" Origin"), " Direction=\"" + direction + "\"");
  };
  EXPECT_EQ(readText(textWith("1 0 0 0 1 -1e-17 0 0 1")).grid.spacing_m, (Vec3d{1, 2, 3}));
  for (const char* direction : {"0 -1 0 1 0 0 0 0 1", "-1 0 0 0 1 0 0 0 1", "1 0.1 0 0 1 0 0 0 1"}) {
    EXPECT_THAT(
        errorOf([&] { readText(textWith(direction)); }),
        HasSubstr("a.vti: the grid is rotated, sheared or mirrored; grids whose axes are x, y and z"));
  }
}

TEST(ForeignVti, OnAGridBeyondTheLimitsIsRefused) {
  const auto refusal = [](const std::string& from, const std::string& to) {
    std::string text = vti("", "type=\"UInt8\" format=\"ascii\">1 2 3 4", "");
    text.replace(text.find(from), from.size(), to);
    return errorOf([&] { readText(text); });
  };
  EXPECT_THAT(refusal("Spacing=\"1 2 3\"", "Spacing=\"1 0 3\""),
              HasSubstr("a.vti: spacing_m in y 0 m is outside the allowed range 1e-20 to 1e+20 m"));
  EXPECT_THAT(refusal("Origin=\"10", "Origin=\"1e300"),
              HasSubstr("first_center_m in x 1e+300 m is outside the allowed range -1e+12 to 1e+12 m"));
}

TEST(ForeignVti, IsRefusedWhereItCannotBeRead) {
  const auto refusal = [](const std::string& text) { return errorOf([&] { readText(text); }); };
  EXPECT_THAT(refusal(vti("", "type=\"UInt8\" format=\"hex\">1 2 3 4", "")),
              HasSubstr("stored as \"hex\"; appended, binary and ascii can be read"));
  EXPECT_THAT(
      refusal(vti("compressor=\"vtkLZ4DataCompressor\"", "type=\"UInt8\" format=\"binary\">AA==", "")),
      HasSubstr("compressed with vtkLZ4DataCompressor"));
  EXPECT_THAT(refusal(vti("", "type=\"UInt8\" NumberOfComponents=\"3\" format=\"binary\">AA==", "")),
              HasSubstr("has 3 components"));
  EXPECT_THAT(refusal(vti("", "type=\"Int64\" format=\"binary\">AA==", "")), HasSubstr("of type Int64"));
  EXPECT_THAT(refusal(vti("", "type=\"Float32\" format=\"binary\">BAAAAAECA/o=", "")),
              HasSubstr("expected 16 bytes, found 4"));
  EXPECT_THAT(refusal("<VTKFile type=\"PolyData\"></VTKFile>"), HasSubstr("of type \"PolyData\""));
  EXPECT_THAT(refusal("<VTKFile type=\"ImageData\">\n<x></VTKFile>"), HasSubstr("a.vti:2: XML:"));
  EXPECT_THAT(refusal("nothing"), HasSubstr("no VTK XML file"));
}

TEST(Pvd, StepNeedsAValidTime) {
  TemporaryFolder folder;
  const auto read = [&](const std::string& timestep) {
    const std::string text = "<VTKFile type=\"Collection\"><Collection><DataSet " + timestep +
                             " file=\"a.vti\"/></Collection></VTKFile>";
    writeBytes(folder / "a.pvd", {text.begin(), text.end()});
    return readPvd(folder / "a.pvd").at(0).time_s;
  };
  EXPECT_EQ(read("timestep=\" 1.5e1 \""), 15);
  EXPECT_EQ(read("timestep=\"+1.5\""), 1.5);
  EXPECT_EQ(read("timestep=\"-1e-400\""), 0);
  EXPECT_EQ(read(""), 0);
  for (const char* text : {"", "noon", "1.5 s", "1,5", "+", "+-1", "++1", "-+1"}) {
    EXPECT_THAT(errorOf([&] { read("timestep=\"" + std::string(text) + "\""); }),
                HasSubstr("a.pvd: timestep=\"" + std::string(text) + "\" is not a number of seconds"));
  }
  for (const char* text : {"nan", "inf", "1e99", "1e400", "-1e400"}) {
    EXPECT_THAT(errorOf([&] { read("timestep=\"" + std::string(text) + "\""); }),
                HasSubstr(" s is outside the allowed range -1e+12 to 1e+12 s"));
  }
}

TEST(Pvd, WithSeveralPartsOfAStepIsRefused) {
  TemporaryFolder folder;
  const auto read = [&](const std::string& first, const std::string& second) {
    const std::string text = "<VTKFile type=\"Collection\"><Collection><DataSet " + first +
                             " file=\"a.vti\"/><DataSet " + second +
                             " file=\"b.vti\"/></Collection></VTKFile>";
    writeBytes(folder / "a.pvd", {text.begin(), text.end()});
    return readPvd(folder / "a.pvd").size();
  };
  EXPECT_THAT(errorOf([&] { read("timestep=\"1.5e0\" part=\"0\"", "timestep=\"1.5\" part=\"1\""); }),
              HasSubstr("a.pvd: timestep=\"1.5\" has the parts 0 and 1; series of one part can be read"));
  EXPECT_THAT(errorOf([&] { read("timestep=\"0\"", "timestep=\"0\" part=\"1\""); }),
              HasSubstr("parts 0 and 1"));
  EXPECT_EQ(read("timestep=\"0\" part=\"0\"", "timestep=\"1\" part=\"1\""), 2U);
}

TEST(Pvd, ListsASeriesAndCanBeRewritten) {
  TemporaryFolder folder;
  std::vector<PvdEntry> entries = {{0, folder / "a_0001.vti"}, {0.1, "/elsewhere/a_0002.vti"}};
  writePvd(folder / "a.pvd", entries);
  entries.push_back({0.5, folder.path() / "sub" / "a & b.vti"});
  writePvd(folder / "a.pvd", entries);
  const std::vector<PvdEntry> read = readPvd(folder / "a.pvd");
  ASSERT_EQ(read.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read[i].time_s, entries[i].time_s);
    EXPECT_EQ(read[i].file, entries[i].file);
  }
  const std::vector<std::uint8_t> bytes = readWhole(folder / "a.pvd");
  EXPECT_THAT(std::string(bytes.begin(), bytes.end()), HasSubstr("file=\"a_0001.vti\""));
  survivesDamage(folder / "a.pvd", [&] { readPvd(folder / "a.pvd"); });
}

}  // namespace
}  // namespace emscape::volume
