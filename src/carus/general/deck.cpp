// SPDX-License-Identifier: Apache-2.0
#include "carus/general/deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <map>

#include "carus/core/error.hpp"

namespace carus::general {
namespace {

using material::Law;

/// ccx wants short names of letters and digits.
std::string label(const std::string& name, char kind, std::size_t index) {
  std::string out = fmt::format("{}{}", kind, index);
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 && out.size() < 20) out += char(std::toupper(c));
  }
  return out;
}

/// ccx cuts a field off after 20 characters, exponent and all.
std::string number(double v) { return fmt::format("{:.13g}", v); }

class Deck {
 public:
  Deck(const scenario::ModelScenario& s, const GeneralModel& m) : s_(s), m_(m.model), watched_(m.watched) {}

  std::string text() {
    refuse_what_cannot_be_said();
    line("** {}: written by carus export ccx", s_.name);
    mesh();
    sets();
    materials();
    step();
    return std::move(text_);
  }

 private:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  void refuse_what_cannot_be_said() {
    std::vector<std::string> problems;
    const auto refuse = [&](bool bad, const std::string& what) {
      if (bad) problems.push_back(fmt::format("{}: {}: cannot be said in a deck; leave it out", s_.file, what));
    };
    refuse(!m_.contact_pairs.empty(), "contact.pairs");
    refuse(!m_.ties.empty(), "ties");
    for (const auto& r : m_.regions) {
      refuse(r.rigid, "regions: " + r.name + ": rigid");
      refuse(!r.material.prony.empty(), "regions: " + r.name + ": prony");
      refuse(r.material.average_nodal_pressure, "regions: " + r.name + ": average_nodal_pressure");
      refuse(r.material.law == Law::hooke_corotated, "regions: " + r.name + ": hooke_corotated");
      small_ |= r.material.law == Law::hooke_small_strain;
      large_ |= r.material.law != Law::hooke_small_strain;
    }
    refuse(small_ && large_, "regions: small and large strain side by side");
    for (const auto& motion : m_.motions) refuse(bool(motion.angle), "motions: " + motion.name + ": angle");
    for (const auto& p : m_.pressures) refuse(p.directed, "pressures: " + p.name + ": direction");
    if (!problems.empty()) throw InputError(problems);
  }

  void mesh() {
    line("*NODE, NSET=NALL");
    for (std::size_t i = 0; i < m_.mesh.nodes.size(); ++i) {
      const Vec3& x = m_.mesh.nodes[i];
      line("{}, {}, {}, {}", i + 1, number(x.x()), number(x.y()), number(x.z()));
    }
    for (std::size_t r = 0; r < m_.regions.size(); ++r) {
      line("*ELEMENT, TYPE=C3D4, ELSET={}", label(m_.regions[r].name, 'E', r));
      for (std::size_t e = 0; e < m_.mesh.tets.size(); ++e) {
        if (m_.mesh.labels[e] != std::int32_t(r)) continue;
        const auto& t = m_.mesh.tets[e];
        line("{}, {}, {}, {}, {}", e + 1, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1);
      }
    }
  }

  void sets() {
    for (std::size_t k = 0; k < watched_.size(); ++k) {
      line("*NSET, NSET={}", label(watched_[k].name, 'N', k));
      for (const auto n : watched_[k].nodes) line("{},", n + 1);
    }
  }

  void materials() {
    for (std::size_t r = 0; r < m_.regions.size(); ++r) {
      const auto& m = m_.regions[r].material;
      line("*MATERIAL, NAME={}", label(m_.regions[r].name, 'M', r));
      if (m.law == Law::neo_hooke) {
        line("*HYPERELASTIC, NEO HOOKE\n{}, {}", number(m.c10), number(2 / m.bulk_modulus()));
      } else if (m.law == Law::mooney_rivlin) {
        line("*HYPERELASTIC, MOONEY-RIVLIN\n{}, {}, {}", number(m.c10), number(m.c01), number(2 / m.bulk_modulus()));
      } else {
        line("*ELASTIC\n{}, {}", number(m.youngs_modulus), number(m.poisson));
      }
      line("*DENSITY\n{}", number(m.density));
      line("*SOLID SECTION, ELSET={}, MATERIAL={}", label(m_.regions[r].name, 'E', r),
           label(m_.regions[r].name, 'M', r));
    }
  }

  void step() {
    const double end = s_.duration;
    line("*STEP{}, INC=1000", small_ ? "" : ", NLGEOM");
    line("*STATIC\n0.1, 1.");
    line("*BOUNDARY");
    for (std::size_t i = 0; i < m_.blocked.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        if ((m_.blocked[i] >> k) & 1) line("{}, {}, {}, 0.", i + 1, k + 1, k + 1);
      }
    }
    for (const auto& motion : m_.motions) {
      const Vec3 u = motion.displacement ? motion.displacement(end) : Vec3::Zero();
      for (const auto n : motion.nodes) {
        for (int k = 0; k < 3; ++k) {
          if ((motion.axes >> k) & 1) line("{}, {}, {}, {}", n + 1, k + 1, k + 1, number(u[k]));
        }
      }
    }
    pressures(end);
    body_forces(end);
    for (std::size_t k = 0; k < watched_.size(); ++k) {
      line("*NODE PRINT, NSET={}, TOTALS=ONLY, FREQUENCY=1000\nRF", label(watched_[k].name, 'N', k));
      line("*NODE PRINT, NSET={}, FREQUENCY=1000\nU", label(watched_[k].name, 'N', k));
    }
    line("*END STEP");
  }

  void pressures(double end) {
    if (m_.pressures.empty()) return;
    // Faces of a C3D4: 1-2-3, 1-4-2, 2-4-3, 3-4-1.
    constexpr int faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    std::map<mesh::Triangle, std::pair<std::size_t, int>> face_of;
    const auto sorted = [](mesh::Triangle t) {
      std::sort(t.begin(), t.end());
      return t;
    };
    for (std::size_t e = 0; e < m_.mesh.tets.size(); ++e) {
      for (int f = 0; f < 4; ++f) {
        const auto& t = m_.mesh.tets[e];
        face_of[sorted({t[faces[f][0]], t[faces[f][1]], t[faces[f][2]]})] = {e + 1, f + 1};
      }
    }
    line("*DLOAD");
    for (const auto& p : m_.pressures) {
      for (const auto& t : p.surface) {
        const auto it = face_of.find(sorted(t));
        if (it != face_of.end()) line("{}, P{}, {}", it->second.first, it->second.second, number(p.pressure(end)));
      }
    }
  }

  void body_forces(double end) {
    for (const auto& b : m_.body_forces) {
      const Vec3 a = b.acceleration(end);
      if (a.norm() == 0) continue;
      const Vec3 d = a.normalized();
      for (std::size_t r = 0; r < m_.regions.size(); ++r) {
        if (!b.regions.empty() && std::find(b.regions.begin(), b.regions.end(), std::int32_t(r)) == b.regions.end())
          continue;
        line("*DLOAD\n{}, GRAV, {}, {}, {}, {}", label(m_.regions[r].name, 'E', r), number(a.norm()), number(d.x()),
             number(d.y()), number(d.z()));
      }
    }
  }

  const scenario::ModelScenario& s_;
  const fem::Model& m_;
  const std::vector<mesh::NamedNodes>& watched_;
  bool small_ = false, large_ = false;
  std::string text_;
};

}  // namespace

std::string ccx_deck(const scenario::ModelScenario& scenario, const GeneralModel& model) {
  return Deck(scenario, model).text();
}

}  // namespace carus::general
