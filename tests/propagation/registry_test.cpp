// The rows of the registry: complete, in order, and in agreement with settings and reference data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "emfield/check/reference_check.h"
#include "propagation/registry/model_info.h"
#include "tests/support/files.h"

namespace emscape::propagation {
namespace {

TEST(Registry, HoldsEveryModelOnceInTheOrderOfTheEnumeration) {
  ASSERT_EQ(models().back().model, PropagationModel::parabolic_equation);
  for (std::size_t i = 0; i < models().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(models()[i].model), i);
    EXPECT_EQ(models()[i].name, toString(models()[i].model));
    EXPECT_EQ(&modelInfo(models()[i].model), &models()[i]);
    EXPECT_NE(models()[i].explain, nullptr) << models()[i].name;
    EXPECT_FALSE(models()[i].reference.empty()) << models()[i].name;
  }
}

TEST(Registry, AccuracyEqualsTableInDocumentation) {
  std::string page = test::readFile(test::sourceFile("docs/models.md"));
  page.erase(std::remove(page.begin(), page.end(), '`'), page.end());
  for (const ModelInfo& row : models()) {
    EXPECT_THAT(page, testing::HasSubstr(" | " + row.accuracy + " | ")) << row.name;
  }
}

TEST(Registry, SettingsRoundTripIsExact) {
  for (const ModelInfo& row : models()) {
    EXPECT_EQ(row.settings.empty(), row.settings_description.empty()) << row.name;
    for (const Setting& setting : row.settings) {
      SCOPED_TRACE(row.name + "." + setting.key);
      const double last =
          setting.choices.empty() ? setting.max : static_cast<double>(setting.choices.size()) - 1;
      ModelSettings settings;
      const ModelSettings defaults;
      EXPECT_GE(setting.get(defaults), setting.choices.empty() && !setting.has_auto ? setting.min : 0);
      EXPECT_LE(setting.get(defaults), last);
      EXPECT_TRUE(areSame(settings, defaults));
      const double other = setting.get(defaults) == last ? 0 : last;
      setting.set(settings, other);
      EXPECT_EQ(setting.get(settings), other);
      EXPECT_FALSE(areSame(settings, defaults));
    }
  }
}

TEST(Registry, NamesReferenceDatasetsThatACheckKnows) {
  const auto& known = emfield::referenceDatasets();
  for (const ModelInfo& row : models()) {
    for (const std::string& name : row.reference_datasets) {
      EXPECT_TRUE(std::any_of(known.begin(), known.end(), [&](const emfield::ReferenceDataset& dataset) {
        return dataset.name == name && dataset.check != nullptr;
      })) << name;
    }
  }
}

TEST(Registry, FindsModelsByNameAndSettingsThatEnter) {
  ASSERT_NE(modelNamed("itm"), nullptr);
  EXPECT_EQ(modelNamed("itm")->model, PropagationModel::itm);
  EXPECT_EQ(modelNamed("longley_rice"), nullptr);
  const ModelInfo& itm = modelInfo(PropagationModel::itm);
  const ModelInfo& diffraction = modelInfo(PropagationModel::diffraction);
  EXPECT_TRUE(settingsEnter(itm, itm));
  EXPECT_TRUE(settingsEnter(diffraction, itm));
  EXPECT_FALSE(settingsEnter(itm, diffraction));
}

TEST(Registry, AddsGasesByTheRoleOfTheModelAndTheAtmosphere) {
  const auto has = [](PropagationModel model, GasLosses gases) {
    EmitterInputs inputs;
    inputs.settings.model = model;
    inputs.atmosphere.gases = gases;
    return hasGases(inputs);
  };
  EXPECT_FALSE(has(PropagationModel::free_space, GasLosses::automatic));
  EXPECT_TRUE(has(PropagationModel::free_space, GasLosses::always));
  EXPECT_TRUE(has(PropagationModel::itm, GasLosses::automatic));
  EXPECT_FALSE(has(PropagationModel::itm, GasLosses::never));
  EXPECT_FALSE(has(PropagationModel::p528, GasLosses::always));
}

TEST(Registry, ReportsRefusalsOfAModelWithTheirOrigin) {
  EmitterInputs inputs;
  inputs.settings.model = PropagationModel::itm;
  inputs.frequency_hz = 40e9;
  const InputFaults faults = modelInfo(PropagationModel::itm).check(inputs);
  ASSERT_FALSE(faults.empty());
  EXPECT_TRUE(faults.front().is_refused);
  EXPECT_EQ(faults.front().origin, InputOrigin::frequency);
  EXPECT_THAT(faults.front().message, testing::HasSubstr("frequency 40000 MHz is outside"));
}

}  // namespace
}  // namespace emscape::propagation
