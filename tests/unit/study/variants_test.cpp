// SPDX-License-Identifier: Apache-2.0
#include "carus/study/variants.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../results/mover.hpp"
#include "carus/core/error.hpp"

namespace carus::study {
namespace {

namespace fs = std::filesystem;
using Messages = std::vector<std::string>;
const fs::path reference = fs::path(CARUS_SOURCE_DIR) / "scenarios/reference.yaml";

fs::path written(const test::Folder& folder, const std::string& text) {
  std::ofstream(folder / "v.yaml") << text;
  return folder / "v.yaml";
}

template <class F>
Messages problems(F&& f) {
  try {
    f();
    return {};
  } catch (const InputError& error) {
    return error.problems();
  }
}

TEST(Variants, AreRead) {
  const test::Folder folder("variants");
  const auto v = read_variants(written(folder, R"(
description: two
variants:
  - {name: half_drag, set: [numerics.drag_factor*=0.5, "canal.radius=45 mm"]}
  - {name: strict, scenario: ../paper_strict.yaml}
)"));
  ASSERT_EQ(v.size(), 2u);
  EXPECT_EQ(v[0].name, "half_drag");
  EXPECT_EQ(v[0].set, (Messages{"numerics.drag_factor*=0.5", "canal.radius=45 mm"}));
  EXPECT_TRUE(v[0].scenario.empty());
  EXPECT_EQ(v[1].scenario, folder.path().parent_path() / "paper_strict.yaml");
}

TEST(Variants, EveryProblemNamesFileAndRow) {
  const test::Folder folder("bad_variants");
  const auto file = written(folder, R"(
descripton: typo
variants:
  - {name: a, sett: [x=1], set: [x=1]}
  - {set: [x=1]}
  - {name: a, set: [x=1]}
  - {name: base, set: [x=1]}
  - {name: "a/b", set: [x=1]}
  - {name: b}
  - {name: c, set: x=1}
  - {name: d, set: [nonsense]}
  - {name: e, scenario: [f.yaml]}
  - f
)");
  const std::string f = file.string();
  EXPECT_EQ(problems([&] { read_variants(file); }),
            (Messages{
                f + ": descripton: unknown key; did you mean description?",
                f + ": variants[0] (a): unknown key sett; did you mean set?",
                f + ": variants[1]: has no name; allowed letters, digits, _ and -",
                f + ": variants[2] (a): name given twice; each row has a folder of its own; choose another",
                f + ": variants[3] (base): the name is taken by the scenario itself; choose another",
                f + ": variants[4] (a/b): the name is a folder's; allowed letters, digits, _ and -",
                f + ": variants[5] (b): changes nothing; allowed set: [key=value, ...] or scenario: FILE",
                f + ": variants[6] (c): set is not a list; allowed [key=value, ...]",
                f + ": variants[7] (d): set: \"nonsense\" is not an assignment; allowed path.to.key=value or "
                    "path.to.key*=factor",
                f + ": variants[8] (e): scenario is not a file's name; allowed a YAML file, relative to this one",
                f + ": variants[9]: is not a map; allowed {name: ..., set: [key=value, ...], scenario: FILE}",
            }));
}

TEST(Variants, FilesThatAreNotThereOrEmpty) {
  const test::Folder folder("no_variants");
  EXPECT_EQ(problems([&] { read_variants("nowhere.yaml"); }),
            Messages{"\"nowhere.yaml\" cannot be opened; allowed a readable YAML file; check the path"});
  const auto file = written(folder, "description: none\n");
  EXPECT_EQ(problems([&] { read_variants(file); }),
            Messages{file.string() + ": variants: no rows; allowed a list of {name: ..., set: [key=value, ...]}"});
}

TEST(Variants, NamesMeanFilesBesideTheScenario) {
  EXPECT_EQ(find_variants("robustness", reference), reference.parent_path() / "studies/robustness.yaml");
  EXPECT_EQ(find_variants("mine/v.yaml", reference), "mine/v.yaml");
  EXPECT_EQ(problems([&] { find_variants("drags", reference); }),
            Messages{"--variants: \"drags\" is no set of variants; allowed contact, drag, mesh, robustness, "
                     "time_scaling; or name a file that ends in .yaml"});
  EXPECT_EQ(problems([&] { find_variants("drag", "nowhere/s.yaml"); }),
            Messages{"--variants: \"drag\" is no set of variants; allowed none, \"nowhere/studies\" has no sets; or "
                     "name a file that ends in .yaml"});
}

TEST(Variants, ShippedSetsResolve) {
  for (const char* set : {"contact", "drag", "mesh", "robustness", "time_scaling"}) {
    const auto variants = read_variants(find_variants(set, reference));
    EXPECT_EQ(rows_of(reference, {}, variants).size(), variants.size() + 1) << set;
  }
}

TEST(Variants, RowsComeAfterTheOverridesAndMayMultiply) {
  const auto rows = rows_of(reference, {"numerics.drag_factor=3", "canal.radius=40 mm", "contact.sweeps=3"},
                            {{"a", {"numerics.drag_factor*=0.5", "canal.radius*=1.1", "contact.sweeps*=2"}, {}},
                             {"b", {"canal.radius=50 mm", "canal.radius*=0.9"}, {}},
                             {"strict", {}, reference.parent_path() / "paper_strict.yaml"}});
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].name, "base");
  EXPECT_DOUBLE_EQ(rows[0].scenario.numerics.drag_factor, 3);
  EXPECT_DOUBLE_EQ(rows[1].scenario.numerics.drag_factor, 1.5);
  EXPECT_DOUBLE_EQ(rows[1].scenario.anatomy.canal.radius, 0.044);
  EXPECT_EQ(rows[1].scenario.contact.sweeps, 6);
  EXPECT_DOUBLE_EQ(rows[2].scenario.anatomy.canal.radius, 0.045);
  EXPECT_FALSE(rows[3].scenario.retraction.enabled);
  EXPECT_DOUBLE_EQ(rows[3].scenario.numerics.drag_factor, 3);
}

TEST(Variants, ARowThatIsAnEarlierOneIsComputedOnce) {
  const auto rows = rows_of(reference, {"resolution=paper"},
                            {{"paper", {"resolution=paper"}, {}}, {"coarse", {"resolution=coarse"}, {}}});
  EXPECT_EQ(rows[0].same_as, "");
  EXPECT_EQ(rows[1].same_as, "base");
  EXPECT_EQ(rows[2].same_as, "");
}

TEST(Variants, ProblemsOfAllRowsNameTheirRow) {
  EXPECT_EQ(problems([&] {
              rows_of(reference, {},
                      {{"a", {"numerics.drag_facto=1"}, {}},
                       {"b", {"canal.radius*=wide"}, {}},
                       {"c", {"uterus.retraction.kind*=2"}, {}},
                       {"d", {"canal.radus*=2"}, {}},
                       {"e", {}, "none.yaml"},
                       {"f", {"numerics.threads=1", "numerics.threads*=0.5"}, {}}});
            }),
            (Messages{
                "row a: --set: numerics.drag_facto: unknown key; did you mean numerics.drag_factor?",
                "row b: canal.radius*=wide: \"wide\" is not a number; allowed path.to.key*=factor",
                "row c: uterus.retraction.kind: \"ratchet\" cannot be multiplied; allowed keys with a number or "
                "quantity; write uterus.retraction.kind=...",
                "row d: canal.radus: unknown key; did you mean canal.radius?",
                "row e: \"none.yaml\" cannot be opened; allowed a readable YAML file; check the path",
                "row f: --set: numerics.threads: \"0.5\" is not an integer; allowed 0 to 1024; the default is \"0\"",
            }));
}

}  // namespace
}  // namespace carus::study
