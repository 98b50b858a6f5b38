// SPDX-License-Identifier: Apache-2.0
#include "carus/scenario/scenario.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "carus/core/error.hpp"
#include "carus/core/units.hpp"
#include "carus/scenario/schema.hpp"

namespace carus::scenario {
namespace {

namespace fs = std::filesystem;
const fs::path source = CARUS_SOURCE_DIR;

/// The problems of a text with overrides, or nothing.
std::vector<std::string> problems(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  try {
    parse(yaml, "s.yaml", overrides);
    return {};
  } catch (const InputError& error) {
    return error.problems();
  }
}
using Messages = std::vector<std::string>;

TEST(Scenario, EmptyFileIsAllDefaults) {
  const Scenario s = parse("", "folder/empty.yaml");
  EXPECT_EQ(s.name, "empty");
  EXPECT_EQ(s.resolution, Resolution::paper);
  EXPECT_DOUBLE_EQ(s.materials.at("skull").c10, 75e3);
  EXPECT_DOUBLE_EQ(s.materials.at("abdomen").density, 2500);
  EXPECT_EQ(s.materials.at("bone").law, material::Law::hooke_corotated);
  EXPECT_DOUBLE_EQ(s.loads.push.amplitude, 200 * units::mmHg);
  EXPECT_DOUBLE_EQ(s.numerics.time_step, 25e-6);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(Scenario, UnitsAreConvertedOnce) {
  const Scenario s = parse(R"(
canal: {radius: 4.6 cm, bend_angle: 1 rad}
loads: {contractions: {period: 4 min}, push: {amplitude: 26.6644774 kPa}}
materials: {skull: {density: 1.1 g/cm^3}}
coccyx: {stiffness: 1 N m/deg, damping: 3 N·m·s/rad}
numerics: {drag: 1.2e6 1/min}
)",
                           "s.yaml");
  EXPECT_DOUBLE_EQ(s.anatomy.canal.radius, 0.046);
  EXPECT_DOUBLE_EQ(s.anatomy.canal.bend_angle, 1);
  EXPECT_DOUBLE_EQ(s.loads.contractions.period, 240);
  EXPECT_DOUBLE_EQ(s.loads.push.amplitude, 26664.4774);
  EXPECT_DOUBLE_EQ(s.materials.at("skull").density, 1100);
  EXPECT_DOUBLE_EQ(s.coccyx.stiffness, 180 / pi);
  EXPECT_DOUBLE_EQ(s.coccyx.damping, 3);
  EXPECT_DOUBLE_EQ(s.numerics.drag, 2e4);
}

TEST(Scenario, OverridesWinAndMayBeLists) {
  const Scenario s = parse("fetus: {position: OA}\n", "s.yaml",
                           {"fetus.position=ROA", "loads.push.enabled=false",
                            "materials.skull.prony=[{g: 0.25, tau: 2 min}]", "canal.radius=45 mm", "name=tried"});
  EXPECT_EQ(s.anatomy.fetus.position, anatomy::Position::ROA);
  EXPECT_FALSE(s.loads.push.enabled);
  ASSERT_EQ(s.materials.at("skull").prony.size(), 1u);
  EXPECT_DOUBLE_EQ(s.materials.at("skull").prony[0].tau, 120);
  EXPECT_DOUBLE_EQ(s.anatomy.canal.radius, 0.045);
  EXPECT_EQ(s.name, "tried");
}

TEST(Scenario, BadOverridesAreNamed) {
  EXPECT_EQ(
      problems("", {"fetus.positon=OA", "loads.push.amplitude=50 mm", "nonsense", "canal.radius.x=1 mm"}),
      (Messages{"--set: \"nonsense\" is not an assignment; allowed path.to.key=value; write it like fetus.position=LOA",
                "--set: canal.radius: a map is not a quantity; allowed 25 mm to 80 mm; the default is \"46 mm\"",
                "--set: fetus.positon: unknown key; did you mean fetus.position?",
                "--set: loads.push.amplitude: \"50 mm\" has the unit mm, not one of pressure (one of Pa, kPa, MPa, "
                "GPa, mmHg); allowed 0 mmHg to "
                "600 mmHg; the default is \"200 mmHg\""}));
}

TEST(Scenario, UnknownKeysTellTheNearest) {
  EXPECT_EQ(problems("reslution: paper\npush: {enabled: false}\nuterus: {retraction: {kinds: ratchet}}\nmaterials: "
                     "{skull: {prony: [{gg: 0.1}]}}\n"),
            (Messages{"s.yaml: reslution: unknown key; did you mean resolution?",
                      "s.yaml: push: unknown key; did you mean loads.push?",
                      "s.yaml: uterus.retraction.kinds: unknown key; did you mean uterus.retraction.kind?",
                      "s.yaml: materials.skull.prony[0].gg: unknown key; did you mean materials.skull.prony[].g?"}));
}

TEST(Scenario, EveryKindOfProblemAndAllAtOnce) {
  EXPECT_EQ(
      problems(R"(
canal: {radius: 46, bend_radius: 3 kPa, bend_start: 90 furlong, bend_angle: wide}
numerics: {safety: .nan, drag_factor: 1e999, threads: 1.5, pseudo_duration: inf s}
uterus: {retraction: {enabled: yes, kind: rachet, floor: "0.2"}}
fetus: [1, 2]
coccyx: {model: , damping: [1 s]}
calibrated: {key: canal.radius}
pelvis: {interspinous: -3 mm}
output: {frames: 5 s}
)"),
      (Messages{
          "s.yaml: calibrated: a map is not a list; allowed a list of items with the keys key, to; write it below "
          "calibrated, indented",
          "s.yaml: pelvis.interspinous: \"-3 mm\" is out of range; allowed 50 mm to 190 mm; the default is \"112.3 "
          "mm\"",
          "s.yaml: canal.radius: \"46\" has no unit (one of m, cm, mm); allowed 25 mm to 80 mm; the default is \"46 "
          "mm\"",
          "s.yaml: canal.bend_radius: \"3 kPa\" has the unit kPa, not one of length (one of m, cm, mm); allowed 40 mm "
          "to 1000 mm; the default is "
          "\"80 mm\"",
          "s.yaml: canal.bend_start: \"90 furlong\" has the unit furlong, not one of length (one of m, cm, mm); "
          "allowed -150 mm to 50 mm; the default "
          "is \"-45 mm\"",
          "s.yaml: canal.bend_angle: \"wide\" is not a quantity; allowed 0 deg to 120 deg; the default is \"49.85 "
          "deg\"",
          "s.yaml: uterus.retraction.enabled: \"yes\" is not a boolean; allowed true or false; the default is \"true\"",
          "s.yaml: uterus.retraction.kind: \"rachet\" is not one of the choices; allowed ratchet, imposed; did you "
          "mean \"ratchet\"?",
          "s.yaml: uterus.retraction.floor: \"0.2\" is not a number; allowed 0.05 to 1; the default is \"0.2\"",
          "s.yaml: fetus: a list is not a map; allowed the keys biparietal, occipitofrontal, suboccipitobregmatic, "
          "shoulder_width, length, "
          "skin_thickness, flexion, head_start, position, asynclitism; write it below fetus, indented",
          "s.yaml: coccyx.model: nothing is not one of the choices; allowed hinge, elastic, fixed; the default is "
          "\"hinge\"",
          "s.yaml: coccyx.damping: a list is not a quantity; allowed 0 N m s/rad to 1000000 N m s/rad; the default is "
          "\"200 N m s/rad\"",
          "s.yaml: numerics.pseudo_duration: \"inf s\" is not finite; allowed 0.01 s to 1000 s; the default is \"2 s\"",
          "s.yaml: numerics.safety: \".nan\" is not finite; allowed 0.05 to 0.95; the default is \"0.5\"",
          "s.yaml: numerics.drag_factor: \"1e999\" is not finite; allowed 0 to 100; the default is \"1\"",
          "s.yaml: numerics.threads: \"1.5\" is not an integer; allowed 0 to 1024; the default is \"0\"",
          "s.yaml: output.frames: \"5 s\" is not an integer; allowed 0 to 100000; the default is \"120\"",
      }));
}

TEST(Scenario, PaceHasItsBounds) {
  EXPECT_EQ(
      problems("numerics: {pace: {kinetic_ratio: 0, slowest: 2, fastest: 4 s, slowets: 1}}\n"),
      (Messages{"s.yaml: numerics.pace.slowets: unknown key; did you mean numerics.pace.slowest?",
                "s.yaml: numerics.pace.kinetic_ratio: \"0\" is out of range; allowed 1e-06 to 1; the default is "
                "\"0.04\"",
                "s.yaml: numerics.pace.slowest: \"2\" is out of range; allowed 0.01 to 1; the default is \"1\"",
                "s.yaml: numerics.pace.fastest: \"4 s\" is not a number; allowed 1 to 100; the default is \"1\""}));
}

TEST(Scenario, LandmarksAreOfAVolumeAndNamedOnce) {
  EXPECT_EQ(
      problems("pelvis: {landmarks: [{name: coccyx_tip}, {name: promontory}, {name: coccyx_tip}]}\n"),
      (Messages{"s.yaml: pelvis.landmarks: a list of 3 contradicts other keys; allowed an empty list; without "
                "pelvis.from or pelvis.surfaces there is nothing in which they could have been seen",
                "s.yaml: pelvis.landmarks[2].name: \"coccyx_tip\" contradicts other keys; allowed each name once; "
                "one of the two must go"}));
}

TEST(Scenario, RelationsBetweenKeys) {
  EXPECT_EQ(problems(R"(
loads: {contractions: {duration: 50 s, period: 40 s}, push: {efforts: 6}}
output: {curve_interval: 20 s}
numerics: {labour_duration: 10 s}
fetus: {biparietal: 120 mm}
materials:
  skull: {c01: 1 kPa}
  bone: {youngs_modulus: 0 kPa}
  abdomen: {c10: 0 kPa, fibre: {k1: 1 kPa}, prony: [{g: 0.6}, {g: 0.5}]}
calibrated: [{key: canal.radus}]
solver: {kind: implicit, implicit: {time_step: 1 s, least_time_step: 2 s}}
)"),
            (Messages{
                "s.yaml: loads.contractions.duration: 50 s contradicts other keys; allowed at least 60 s; rise and "
                "fall must fit in: shorten "
                "loads.contractions.rise or fall",
                "s.yaml: loads.contractions.period: 40 s contradicts other keys; allowed at least 50 s; contractions "
                "must not overlap: shorten "
                "loads.contractions.duration",
                "s.yaml: loads.push.effort_duration: 10 s contradicts other keys; allowed at most 8.333333333333334 s; "
                "6 efforts must fit in one "
                "contraction: ask for fewer loads.push.efforts",
                "s.yaml: output.curve_interval: 20 s contradicts other keys; allowed at most 10 s; no row would be "
                "written: raise "
                "numerics.labour_duration",
                "s.yaml: fetus.biparietal: 120 mm contradicts other keys; allowed at most 116 mm; the occipitofrontal "
                "diameter is the longest of the "
                "three: raise fetus.occipitofrontal",
                "s.yaml: materials.abdomen.c10: 0 kPa contradicts other keys; allowed above 0 kPa; neo-Hooke and "
                "Mooney-Rivlin need it",
                "s.yaml: materials.abdomen.prony: sum of g 1.1 contradicts other keys; allowed below 1; something must "
                "remain when all has relaxed",
                "s.yaml: materials.abdomen.fibre.k1: 1 kPa contradicts other keys; allowed 0 kPa; only the uterus has "
                "a field of fibres",
                "s.yaml: materials.bone.youngs_modulus: 0 kPa contradicts other keys; allowed above 0 kPa; Hooke's law "
                "needs it",
                "s.yaml: materials.skull.c01: 1 kPa contradicts other keys; allowed 0 kPa; only the law mooney_rivlin "
                "has it: set materials.skull.law",
                "s.yaml: calibrated[0].key: \"canal.radus\" contradicts other keys; allowed a key of the schema; did "
                "you mean canal.radius?",
                "s.yaml: solver.implicit.least_time_step: 2 s contradicts other keys; allowed at most 1 s; it must not "
                "exceed solver.implicit.time_step",
            }));
}

TEST(Scenario, CanalThatCannotNarrowIsRefused) {
  EXPECT_EQ(
      problems("canal: {radius: 40 mm, vulva_radius: 41 mm, bend_start: -30 mm, bend_radius: 60 mm, bend_angle: 0 "
               "deg, taper_start: 30 mm, floor_top: 60 mm}\n"),
      (Messages{
          "s.yaml: canal.vulva_radius: 41 mm contradicts other keys; allowed at most 40 mm; the canal narrows "
          "towards the vulva: raise canal.radius",
          "s.yaml: canal.taper_start: 30 mm contradicts other keys; allowed below 30 mm; it lies before the "
          "vulva, whose depth canal.bend_start, bend_radius and bend_angle set",
          "s.yaml: canal.floor_top: 60 mm contradicts other keys; allowed below 30 mm; it lies before the "
          "vulva, whose depth canal.bend_start, bend_radius and bend_angle set",
      }));
}

TEST(Scenario, FilesThatCannotBeRead) {
  const auto message = [](const fs::path& file) {
    try {
      load(file);
      return std::string("none");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(message("nowhere/s.yaml"),
            "\"nowhere/s.yaml\" cannot be opened; allowed a readable YAML file; check the path");
  EXPECT_EQ(message(source), fmt::format("\"{}\" is a folder; allowed a YAML file", source.string()));
  EXPECT_EQ(problems("extends: none.yaml\n"),
            Messages{"s.yaml: extends: \"none.yaml\" cannot be opened; allowed a readable YAML file; check the path"});
  EXPECT_EQ(problems("canal: {radius: 46 mm\n"), Messages{"s.yaml: line 2, column 1: bad YAML: end of map flow not "
                                                          "found; write keys as \"key: value\", indented by spaces"});
  EXPECT_EQ(problems("name: a\nname: b\n"), Messages{"s.yaml: name: given twice; allowed once; delete line 2"});
  EXPECT_EQ(problems("- 1\n").front().substr(0, 54), "s.yaml: (whole file): a list is not a map; allowed the");
  EXPECT_EQ(problems("fetus: {position: OA}\n", {"fetus.position=[oops"}).size(), 1u);
}

TEST(Scenario, ExtendsFillsWhatIsSilentAndNamesTheRightFile) {
  const fs::path folder = fs::path(testing::TempDir()) / "carus_extends";
  fs::create_directories(folder);
  std::ofstream(folder / "base.yaml")
      << "name: base\ncanal: {radius: 45 mm, bend_radius: 3 mm}\nmaterials: {skull: {prony: [{g: 0.1}, {g: 0.2}]}}\n";
  std::ofstream(folder / "child.yaml")
      << "extends: base.yaml\ncanal: {bend_radius: 90 mm}\nmaterials: {skull: {prony: [{g: 0.3}]}}\n";
  std::ofstream(folder / "bad.yaml") << "extends: base.yaml\ncanal: {bend_start: 1 kg}\n";
  std::ofstream(folder / "circle.yaml") << "extends: circle.yaml\n";
  const Scenario s = load(folder / "child.yaml");
  EXPECT_EQ(s.name, "child");
  EXPECT_DOUBLE_EQ(s.anatomy.canal.radius, 0.045);
  EXPECT_DOUBLE_EQ(s.anatomy.canal.bend_radius, 0.09);
  EXPECT_EQ(s.materials.at("skull").prony.size(), 1u);
  try {
    load(folder / "bad.yaml");
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 2u);
    EXPECT_EQ(
        error.problems()[0].find((folder / "base.yaml").string() + ": canal.bend_radius: \"3 mm\" is out of range"),
        0u);
    EXPECT_EQ(error.problems()[1].find((folder / "bad.yaml").string() + ": canal.bend_start: \"1 kg\" has the unit kg"),
              0u);
  }
  EXPECT_THROW(load(folder / "circle.yaml"), InputError);
}

TEST(Scenario, ValuesOutsideTheirSourceWarn) {
  const Scenario s = parse("fetus: {biparietal: 90 mm}\n", "s.yaml");
  EXPECT_EQ(s.warnings, Messages{"s.yaml: fetus.biparietal: \"90 mm\" is outside what its source covers; 92.5 to 95 mm "
                                 "(term, obstetric texts)"});
}

TEST(Scenario, ResolvedScenarioReadsBackExactly) {
  for (const char* file : {"reference.yaml", "paper_strict.yaml", "physiological.yaml"}) {
    // A third of a millimetre and mmHg test that no digit is lost.
    const Scenario s = load(source / "scenarios" / file,
                            {"canal.radius=43.333333333333336 mm", "loads.residual_tone.pressure=71.25714 mmHg"});
    const std::string text = resolved_yaml(s);
    const Scenario back = parse(text, "resolved.yaml");
    EXPECT_EQ(resolved_yaml(back), text);
    EXPECT_EQ(back.anatomy.canal.radius, s.anatomy.canal.radius);
    EXPECT_EQ(back.loads.residual_tone.pressure, s.loads.residual_tone.pressure);
    EXPECT_EQ(back.loads.push.amplitude, s.loads.push.amplitude);
    EXPECT_EQ(back.materials.at("vaginal_canal").prony.size(), s.materials.at("vaginal_canal").prony.size());
    EXPECT_EQ(back.name, fs::path(file).stem());
  }
}

TEST(Scenario, ShippedScenariosDifferOnlyInWhatTheyName) {
  const Scenario reference = load(source / "scenarios/reference.yaml"),
                 strict = load(source / "scenarios/paper_strict.yaml"),
                 physiological = load(source / "scenarios/physiological.yaml");
  EXPECT_TRUE(reference.retraction.enabled);
  EXPECT_EQ(reference.retraction.kind, fem::Retraction::Kind::ratchet);
  EXPECT_FALSE(strict.retraction.enabled);
  Scenario same = strict;
  same.retraction = reference.retraction;
  EXPECT_DOUBLE_EQ(same.materials.at("vaginal_canal").c10, 30e3);  // the paper's, elastic
  EXPECT_TRUE(same.materials.at("vaginal_canal").prony.empty());
  same.materials["vaginal_canal"] = reference.materials.at("vaginal_canal");
  same.name = reference.name, same.description = reference.description, same.calibrated = reference.calibrated;
  EXPECT_EQ(resolved_yaml(same), resolved_yaml(reference));
  const labour::Contractions& c = physiological.loads.contractions;
  EXPECT_NEAR((c.base + c.amplitude + physiological.loads.push.amplitude) / units::mmHg, 110,
              10);  // targets.md: 80-120 mmHg with push
  for (const Scenario* s : {&reference, &strict, &physiological}) EXPECT_FALSE(s->calibrated.empty());
}

TEST(Scenario, ExplicitOptionsApplyTheMultipliers) {
  const auto o =
      explicit_options(parse("", "s.yaml",
                             {"numerics.drag_factor=2", "numerics.pseudo_time_factor=3", "numerics.drag=100 1/s",
                              "contact.sweeps=7", "numerics.pace.kinetic_ratio=0.09", "numerics.pace.fastest=4"}));
  EXPECT_DOUBLE_EQ(o.drag, 200);
  EXPECT_DOUBLE_EQ(o.pseudo_duration, 6);
  EXPECT_DOUBLE_EQ(o.pace.kinetic_ratio, 0.01);  // a third of the speed
  EXPECT_DOUBLE_EQ(o.pace.fastest, 4);
  EXPECT_EQ(o.contact_sweeps, 7);
}

TEST(Scenario, MeshFactorScalesEveryEdge) {
  const Scenario one = parse("", "s.yaml"), half = parse("", "s.yaml", {"numerics.mesh_factor=0.5"});
  EXPECT_DOUBLE_EQ(half.anatomy.mesh.uterus, one.anatomy.mesh.uterus / 2);
  EXPECT_DOUBLE_EQ(half.anatomy.mesh.bone, one.anatomy.mesh.bone / 2);
}

TEST(Scenario, TheStepFollowsTheEdgesOfTheWall) {
  const auto step = [](const std::vector<std::string>& set) {
    return explicit_options(parse("", "s.yaml", set)).time_step;
  };
  EXPECT_DOUBLE_EQ(step({"numerics.time_step=50 us", "resolution=paper"}), 50e-6);
  EXPECT_DOUBLE_EQ(step({"numerics.time_step=50 us", "resolution=coarse"}), 50e-6 * 13 / 9);
  EXPECT_DOUBLE_EQ(step({"numerics.time_step=50 us", "resolution=paper", "numerics.mesh_factor=0.5"}), 25e-6);
}

TEST(Scenario, ReferencePageIsUpToDate) {
  const fs::path page = source / "docs/reference/scenario.md";
  if (std::getenv("CARUS_WRITE_DOCS") != nullptr) std::ofstream(page) << schema_markdown();
  std::ifstream stream(page);
  std::ostringstream text;
  text << stream.rdbuf();
  EXPECT_EQ(text.str(), schema_markdown()) << "run the unit tests with CARUS_WRITE_DOCS=1 and look at the change";
}

}  // namespace
}  // namespace carus::scenario
