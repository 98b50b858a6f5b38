// SPDX-License-Identifier: Apache-2.0
// Arrows point down only (docs/theory/architecture.md). CMakeLists.txt says what each module links; here the includes
// are held to it, since a static library would compile with an upward #include and only fail to link, or not even that.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path root = CARUS_SOURCE_DIR;

/// A module and all that it may include, itself among them.
using Reach = std::map<std::string, std::set<std::string>>;

struct Include {
  std::string module;  ///< the folder that includes
  std::string path;    ///< what stands between the quotes or angles
  std::string where;   ///< file:line
};

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// The transitive closure of the links between modules that a CMakeLists.txt declares.
Reach reach_of(const std::string& cmake) {
  const std::string code = std::regex_replace(cmake, std::regex("#[^\n]*"), "");
  const std::regex call(R"((?:carus_module|target_link_libraries)\s*\(\s*(?:carus_)?(\w+)([^)]*)\))");
  const std::regex link(R"(carus_(\w+))");
  Reach reach;
  for (std::sregex_iterator it(code.begin(), code.end(), call), end; it != end; ++it) {
    const std::string module = (*it)[1], arguments = (*it)[2];
    reach[module].insert(module);
    for (std::sregex_iterator to(arguments.begin(), arguments.end(), link); to != end; ++to) {
      reach[module].insert((*to)[1]);
    }
  }
  for (std::size_t before = 0, after = 1; before != after;) {
    before = after;
    after = 0;
    for (auto& [module, below] : reach) {
      for (const std::string& direct : std::set<std::string>(below)) {
        below.insert(reach[direct].begin(), reach[direct].end());
      }
      after += below.size();
    }
  }
  return reach;
}

std::vector<Include> includes_in(const std::string& text, const std::string& module, const std::string& name) {
  const std::regex directive(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> found;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (std::smatch match; std::regex_search(line, match, directive)) {
      found.push_back({module, match[1], name + ":" + std::to_string(number)});
    }
  }
  return found;
}

std::vector<Include> includes_of_sources() {
  std::vector<Include> all;
  for (const auto& entry : fs::recursive_directory_iterator(root / "src/carus")) {
    if (!entry.is_regular_file()) continue;
    const fs::path inside = fs::relative(entry.path(), root / "src/carus");
    const auto found = includes_in(text_of(entry.path()), inside.begin()->string(), inside.string());
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

/// Includes of our headers that the links do not allow.
std::vector<std::string> upward(const std::vector<Include>& includes, const Reach& reach) {
  const std::regex ours(R"(^carus/(\w+)/)");
  std::vector<std::string> wrong;
  for (const Include& include : includes) {
    std::smatch match;
    if (!std::regex_search(include.path, match, ours)) continue;
    const auto allowed = reach.find(include.module);
    if (allowed == reach.end() || !allowed->second.contains(match[1])) {
      wrong.push_back(include.where + " includes " + include.path);
    }
  }
  return wrong;
}

std::string lines(const std::vector<std::string>& items) {
  std::string all;
  for (const std::string& item : items) all += item + "\n";
  return all;
}

const char* const sample = R"(
# carus_module(mesh LINK carus_app)
carus_module(core LINK fmt::fmt)
carus_module(mesh LINK carus_core)
if(X)
  carus_module(fem LINK carus_mesh PRIVATE
               other::lib)
endif()
carus_module(app LINK fmt::fmt)
target_link_libraries(carus_app PRIVATE carus_fem)
)";

TEST(Arrows, LinksAreReadTransitivelyAndWithoutComments) {
  const Reach reach = reach_of(sample);
  EXPECT_EQ(reach.at("core"), (std::set<std::string>{"core"}));
  EXPECT_EQ(reach.at("mesh"), (std::set<std::string>{"core", "mesh"}));
  EXPECT_EQ(reach.at("fem"), (std::set<std::string>{"core", "fem", "mesh"}));
  EXPECT_EQ(reach.at("app"), (std::set<std::string>{"app", "core", "fem", "mesh"}));
}

TEST(Arrows, AnUpwardIncludeIsFound) {
  const auto includes = includes_in(
      "#pragma once\n#include \"carus/core/types.hpp\"\n#include <vector>\n"
      "#  include <carus/fem/model.hpp>\n",
      "mesh", "mesh/bad.hpp");
  const auto wrong = upward(includes, reach_of(sample));
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_EQ(wrong[0], "mesh/bad.hpp:4 includes carus/fem/model.hpp");
}

TEST(Arrows, PointDownOnly) {
  const auto includes = includes_of_sources();
  ASSERT_FALSE(includes.empty()) << "no sources below " << root;
  const auto wrong = upward(includes, reach_of(text_of(root / "CMakeLists.txt")));
  EXPECT_TRUE(wrong.empty()) << lines(wrong);
}

TEST(Arrows, HaveNoCycle) {
  const Reach reach = reach_of(text_of(root / "CMakeLists.txt"));
  for (const auto& [module, below] : reach) {
    for (const std::string& other : below) {
      if (other != module) {
        EXPECT_FALSE(reach.at(other).contains(module)) << module << " and " << other;
      }
    }
  }
}

/// GPL libraries stay behind the one module that CARUS_MESHING switches; the mechanics know no file formats.
TEST(Arrows, ThirdPartiesStayAtTheirEdge) {
  const Reach reach = reach_of(text_of(root / "CMakeLists.txt"));
  const std::regex gpl(R"(^(CGAL/|gmsh))"), files(R"(^(yaml-cpp/|nlohmann/|valijson/|vtk|hdf5|H5))");
  std::vector<std::string> wrong;
  for (const Include& include : includes_of_sources()) {
    const bool mechanics = reach.at("observe").contains(include.module);
    if ((std::regex_search(include.path, gpl) && include.module != "meshing") ||
        (std::regex_search(include.path, files) && mechanics)) {
      wrong.push_back(include.where + " includes " + include.path);
    }
  }
  EXPECT_TRUE(wrong.empty()) << lines(wrong);
}

TEST(Arrows, EveryFolderIsAModule) {
  const Reach reach = reach_of(text_of(root / "CMakeLists.txt"));
  for (const auto& entry : fs::directory_iterator(root / "src/carus")) {
    EXPECT_TRUE(reach.contains(entry.path().filename().string())) << entry.path();
  }
}

}  // namespace
