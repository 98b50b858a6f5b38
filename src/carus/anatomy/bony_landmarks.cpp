// SPDX-License-Identifier: Apache-2.0
#include "carus/anatomy/bony_landmarks.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

#include "carus/core/error.hpp"

namespace carus::anatomy {
namespace {

constexpr double far = std::numeric_limits<double>::infinity();
using Nodes = std::vector<Vec3>;

Vec3 mean(const Nodes& nodes) {
  return std::accumulate(nodes.begin(), nodes.end(), Vec3(Vec3::Zero())) / static_cast<double>(nodes.size());
}

Nodes where(const Nodes& nodes, const std::function<bool(const Vec3&)>& keep) {
  Nodes kept;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(kept), keep);
  return kept;
}

/// Where a landmark was seen, or else what `find` finds.
template <class Find>
Vec3 seen_or_found(const SeenLandmarks& seen, const std::string& name, const Find& find) {
  const auto it = seen.find(name);
  return it == seen.end() ? Vec3(find()) : it->second;
}

/// The node that scores highest; what: for the message if there is none.
Vec3 best(const Nodes& nodes, const std::string& what, const std::function<double(const Vec3&)>& score) {
  if (nodes.empty())
    throw InputError(
        fmt::format("pelvis: {}: none of the bones' nodes is where it is looked for (docs/theory/geometry.md); are the "
                    "bones those of "
                    "one upright pelvis, their labels in the right order?",
                    what));
  return *std::max_element(nodes.begin(), nodes.end(),
                           [&](const Vec3& a, const Vec3& b) { return score(a) < score(b); });
}

/// The nearest of some nodes: candidates in cells of a grid.
class Nearest {
 public:
  explicit Nearest(Nodes nodes) : nodes_(std::move(nodes)) {
    std::sort(nodes_.begin(), nodes_.end(), [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); });
  }
  [[nodiscard]] Vec3 to(const Vec3& x) const {
    Vec3 found = nodes_.front();
    double least = (found - x).norm();
    const auto at = [&](double u) {
      return std::lower_bound(nodes_.begin(), nodes_.end(), u, [](const Vec3& n, double v) { return n.x() < v; });
    };
    const auto start = at(x.x());
    for (auto it = start; it != nodes_.end() && it->x() - x.x() < least; ++it)
      if (const double d = (*it - x).norm(); d < least) least = d, found = *it;
    for (auto it = start; it != nodes_.begin() && x.x() - std::prev(it)->x() < least; --it)
      if (const double d = (*std::prev(it) - x).norm(); d < least) least = d, found = *std::prev(it);
    return found;
  }

 private:
  Nodes nodes_;
};

/// Midpoints between the two innominate bones where they face each other in front.
Nodes symphysis_of(const PelvicBones& b, const Vec3& median, const Vec3& across) {
  // Only what is near the median plane can face the other bone; that also keeps out the back.
  const auto near_plane = [&](const Vec3& x) { return std::abs((x - median).dot(across)) < 0.025; };
  const Nodes left = where(b.left.nodes, near_plane), right = where(b.right.nodes, near_plane);
  if (left.empty() || right.empty())
    throw InputError(
        "pelvis: symphysis: no part of the innominate bones comes within 25 mm of the median plane on either side; are "
        "the labels of the innominate bones right?");
  const Nearest other(right);
  std::vector<std::pair<double, Vec3>> pairs;
  double least = far;
  for (const auto& x : left) {
    const Vec3 y = other.to(x);
    pairs.emplace_back((x - y).norm(), (x + y) / 2);
    least = std::min(least, pairs.back().first);
  }
  Nodes middle;
  for (const auto& [gap, m] : pairs)
    if (gap < least + 0.004) middle.push_back(m);
  return middle;
}

/// Direction in which some nodes extend farthest, pointing along `towards`.
Vec3 long_axis(const Nodes& nodes, const Vec3& towards) {
  const Vec3 c = mean(nodes);
  Mat3 m = Mat3::Zero();
  for (const auto& x : nodes) m += (x - c) * (x - c).transpose();
  const Vec3 axis = Eigen::SelfAdjointEigenSolver<Mat3>(m).eigenvectors().col(2);
  return axis.dot(towards) < 0 ? Vec3(-axis) : axis;
}

struct Median {
  Vec3 promontory, top, bottom;
  double symphysis_height;  ///< of the joint, along it [m]
};

/// The landmarks of the median plane that the frame hangs on, in RAS.
Median median_landmarks(const PelvicBones& b, const SeenLandmarks& seen) {
  const Vec3 right = mean(b.right.nodes), left = mean(b.left.nodes), across = (right - left).normalized();
  const Vec3 median = (right + left) / 2;
  if (across.x() < 0.9)
    throw InputError(
        fmt::format("pelvis: the right innominate bone does not lie to the right of the left one (direction {:.2f}, "
                    "{:.2f}, {:.2f} in "
                    "RAS); are the labels, or the frame's letters, exchanged?",
                    across.x(), across.y(), across.z()));
  const auto joint = symphysis_of(b, median, across);
  const auto box = mesh::box(b.sacrum);
  const double upper = box.max().z() - box.sizes().z() / 3;
  Median m;
  m.promontory = seen_or_found(seen, "promontory", [&] {
    return best(where(b.sacrum.nodes,
                      [&](const Vec3& x) { return x.z() > upper && std::abs((x - median).dot(across)) < 0.010; }),
                "promontory", [](const Vec3& x) { return x.y(); });
  });
  m.top = seen_or_found(seen, "symphysis_top", [&] {
    return best(joint, "top of the symphysis", [&](const Vec3& x) { return -(x - m.promontory).norm(); });
  });
  const Vec3 down = long_axis(joint, -Vec3::UnitZ());
  m.bottom = seen_or_found(seen, "symphysis_bottom", [&] {
    return best(joint, "bottom of the symphysis", [&](const Vec3& x) { return x.dot(down); });
  });
  m.symphysis_height = (m.bottom - best(joint, "symphysis", [&](const Vec3& x) { return -x.dot(down); })).dot(down);
  // The conjugates lie in the median plane, the sacrum's nodes only near it.
  m.promontory -= (m.promontory - median).dot(across) * across;
  m.top -= (m.top - median).dot(across) * across;
  m.bottom -= (m.bottom - median).dot(across) * across;
  return m;
}

PelvicFrame frame_of(const Median& m, const PelvicBones& b) {
  const Vec3 y = (m.top - m.promontory).normalized();
  Vec3 x = mean(b.right.nodes) - mean(b.left.nodes);
  x = (x - x.dot(y) * y).normalized();
  PelvicFrame f;
  f.rotation.row(0) = x, f.rotation.row(1) = y, f.rotation.row(2) = x.cross(y);
  f.origin = (m.top + m.promontory) / 2;
  return f;
}

Nodes in_frame(const Nodes& nodes, const PelvicFrame& f) {
  Nodes moved(nodes.size());
  std::transform(nodes.begin(), nodes.end(), moved.begin(), [&](const Vec3& x) { return f.to_pelvis(x); });
  return moved;
}

class Finder {
 public:
  Finder(const PelvicBones& b, const SeenLandmarks& seen) : seen_(seen) {
    const auto m = median_landmarks(b, seen);
    l_.frame = frame_of(m, b);
    for (auto& [name, x] : seen_) x = l_.frame.to_pelvis(x);
    sides_ = {in_frame(b.right.nodes, l_.frame), in_frame(b.left.nodes, l_.frame)};
    sacrum_ = in_frame(b.sacrum.nodes, l_.frame), coccyx_ = in_frame(b.coccyx.nodes, l_.frame);
    auto& p = l_.points;
    p["inlet"] = Vec3::Zero();
    p["promontory"] = l_.frame.to_pelvis(m.promontory);
    p["symphysis_top"] = l_.frame.to_pelvis(m.top);
    p["symphysis_bottom"] = l_.frame.to_pelvis(m.bottom);
    l_.measures["symphysis_height"] = m.symphysis_height;
  }

  BonyLandmarks run() {
    for (const int side : {0, 1}) innominate(side);
    back();
    measure();
    return std::move(l_);
  }

 private:
  void innominate(int side) {
    const std::string name = side == 0 ? "right" : "left";
    const double sign = side == 0 ? 1 : -1;
    const auto inward = [&](const Vec3& x) { return -sign * x.x(); };
    const auto& nodes = sides_[side];
    auto& p = l_.points;
    p["spine_" + name] = seen_or_found(seen_, "spine_" + name, [&] {
      return best(
          where(nodes, [](const Vec3& x) { return x.z() > -0.095 && x.z() < -0.050 && std::abs(x.y()) < 0.030; }),
          "ischial spine, " + name, [&](const Vec3& x) { return 3 * inward(x) - x.y() - x.z(); });
    });
    p["tuber_" + name] = seen_or_found(seen_, "tuber_" + name, [&] {
      const auto front = where(nodes, [](const Vec3& x) { return x.y() > 0; });
      const Vec3 low = best(front, "tuberosity, " + name, [](const Vec3& x) { return -x.z(); });
      const auto tuber =
          where(front, [&](const Vec3& x) { return x.z() < low.z() + 0.012 && std::abs(x.y() - low.y()) < 0.012; });
      return best(tuber, "tuberosity", inward);
    });
    // The ramus' inner edge, half way from symphysis to tuberosity.
    const Vec3 S = p.at("symphysis_bottom"), T = p.at("tuber_" + name);
    const double half = (S.z() + T.z()) / 2;
    p["ramus_" + name] = seen_or_found(seen_, "ramus_" + name, [&] {
      return best(where(nodes, [&](const Vec3& x) { return std::abs(x.z() - half) < 0.004 && x.y() > T.y(); }),
                  "inferior ramus, " + name, inward);
    });
  }

  void back() {
    auto& p = l_.points;
    const Vec3 tip = p["sacrum_tip"] = seen_or_found(seen_, "sacrum_tip", [&] {
      const Nearest of_coccyx(coccyx_);
      Vec3 nearest = sacrum_.front();
      double least = far;
      for (const auto& x : sacrum_)
        if (const double d = (of_coccyx.to(x) - x).norm(); d < least) least = d, nearest = x;
      return nearest;
    });
    p["coccyx_tip"] = seen_or_found(seen_, "coccyx_tip", [&] {
      return best(coccyx_, "tip of the coccyx", [&](const Vec3& x) { return (x - tip).norm(); });
    });
    const Vec3 P = p.at("promontory"), along = tip - P;
    // Front of the sacrum near the median plane, as a function of the way from promontory to tip.
    const auto front_at = [&](double part) {
      const auto slice = where(sacrum_, [&](const Vec3& x) {
        const double t = (x - P).dot(along) / along.squaredNorm();
        return std::abs(t - part) < 0.04 && std::abs(x.x() - part * tip.x()) < 0.012;
      });
      return best(slice, "front of the sacrum", [](const Vec3& x) { return x.y(); });
    };
    p["coccyx_hinge"] = seen_or_found(seen_, "coccyx_hinge", [&] { return front_at(0.55); });
    p["coccyx_hinge"].x() = 0;
    double deepest = 0;
    for (const double t : {0.3, 0.4, 0.5, 0.6, 0.7}) {
      const Vec3 q = front_at(t) - P, back = Vec3(0, along.z(), -along.y()).normalized();
      deepest = std::max(deepest, std::abs(q.dot(back)));
    }
    l_.measures["sacral_depth"] = deepest;
  }

  /// Greatest distance across the ring at the brim, which is no plane: in slices of 6 mm in y, between the innermost
  /// nodes of each side from 10 mm above to 10 mm below the inlet.
  [[nodiscard]] double transverse_inlet() const {
    double widest = 0;
    const double half = l_.points.at("symphysis_top").y();
    for (double y = -0.5 * half; y < 0.5 * half; y += 0.002) {
      std::array<double, 2> inner{far, far};
      for (const int side : {0, 1})
        for (const auto& x : sides_[side])
          if (std::abs(x.y() - y) < 0.003 && std::abs(x.z()) < 0.010)
            inner[side] = std::min(inner[side], std::abs(x.x()));
      if (inner[0] + inner[1] < 1) widest = std::max(widest, inner[0] + inner[1]);
    }
    return widest;
  }

  void measure() {
    const auto& p = l_.points;
    auto& m = l_.measures;
    const auto distance = [&](const char* a, const char* b) { return (p.at(a) - p.at(b)).norm(); };
    const auto angle = [](const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); };
    m["obstetric_conjugate"] = distance("promontory", "symphysis_top");
    m["diagonal_conjugate"] = distance("promontory", "symphysis_bottom");
    m["transverse_inlet"] = transverse_inlet();
    m["interspinous"] = distance("spine_right", "spine_left");
    m["intertuberous"] = distance("tuber_right", "tuber_left");
    m["sagittal_outlet"] = distance("coccyx_tip", "symphysis_bottom");
    m["sacral_height"] = distance("promontory", "sacrum_tip");
    m["spines_depth"] = -(p.at("spine_right").z() + p.at("spine_left").z()) / 2;
    const Vec3 S = p.at("symphysis_bottom"), Q = p.at("sacrum_tip");
    m["pubic_arch_angle"] = angle(p.at("ramus_right") - S, p.at("ramus_left") - S);
    m["sacrococcygeal_angle"] = angle(p.at("promontory") - Q, p.at("coccyx_tip") - Q);
  }

  SeenLandmarks seen_;  ///< in the pelvis' frame
  BonyLandmarks l_;
  std::array<Nodes, 2> sides_;  ///< right, left, in the pelvis' frame
  Nodes sacrum_, coccyx_;
};

}  // namespace

BonyLandmarks find_landmarks(const PelvicBones& bones, const SeenLandmarks& seen) {
  for (const auto* s : {&bones.right, &bones.left, &bones.sacrum, &bones.coccyx}) CARUS_ASSERT(!s->nodes.empty());
  return Finder(bones, seen).run();
}

PelvisParameters fitted(PelvisParameters p, const BonyLandmarks& l) {
  const auto& m = l.measures;
  p.obstetric_conjugate = m.at("obstetric_conjugate"), p.transverse_inlet = m.at("transverse_inlet");
  p.interspinous = m.at("interspinous"), p.intertuberous = m.at("intertuberous");
  p.sagittal_outlet = m.at("sagittal_outlet"), p.pubic_arch_angle = m.at("pubic_arch_angle");
  p.sacral_height = m.at("sacral_height"), p.sacral_depth = m.at("sacral_depth");
  p.sacrococcygeal_angle = m.at("sacrococcygeal_angle"), p.symphysis_height = m.at("symphysis_height");
  p.spines_depth = m.at("spines_depth");
  return p;
}

CanalParameters fitted(CanalParameters p, const BonyLandmarks& l) {
  const Vec3 S = l.points.at("symphysis_bottom");
  p.bend_radius = S.y() + 0.012;
  p.bend_start = S.z() + 0.007;
  return p;
}

}  // namespace carus::anatomy
