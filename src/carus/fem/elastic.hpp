// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "carus/fem/block_matrix.hpp"
#include "carus/fem/nodal_volume.hpp"
#include "carus/fem/retraction.hpp"
#include "carus/material/prony.hpp"

namespace carus::fem {

/// Elastic energy of a model's deformable elements with gradient and projected Hessian, in double precision.
///
/// Relaxing materials give an incremental potential: over a step the branches h of prony.hpp leave
///     S = S_vol + c S_iso(F) + S_past,  c = 1 - sum g (1 - ramp),  S_past = sum g (decay h_n - ramp S_iso,n),
/// which is the derivative of W_vol + c W_iso + S_past:(F^T F - I)/2, exact for S_iso linear within the step.
class Elastic {
 public:
  explicit Elastic(const Model& model);

  /// Begins a step of dt [s of labour] from the history so far.
  void begin_step(double dt);
  /// Ends it at x: the history moves on. Returns what the instantaneous law counts as stored in this step and
  /// relaxation did not let be put in: (S - S_relaxed):dE, the stresses' mean over the step [J].
  double end_step(const std::vector<Vec3>& x);
  /// The stress-free shape of the retracting elements: F_e = F F_a^-1.
  void set_rest_length(const RestLength& rest_length);

  struct Volumes {
    double min_J = 1;
    std::int32_t worst_element = -1;  ///< of the model
    int inverted = 0;
  };
  /// [J]; +inf where an element is inverted or crushed flat.
  double energy(const std::vector<Vec3>& x);
  /// Stored energy of the materials at x, without what a step's past adds [J].
  double stored(const std::vector<Vec3>& x);
  /// g += dE/dx [N].
  void add_gradient(const std::vector<Vec3>& x, std::vector<Vec3>& g);
  /// Prepares products with the projected Hessian at x.
  void linearise(const std::vector<Vec3>& x);
  /// y = H u; y is overwritten.
  void multiply(const std::vector<Vec3>& u, std::vector<Vec3>& y) const;
  void diagonal(std::vector<Mat3>& d) const;
  [[nodiscard]] Volumes volumes(const std::vector<Vec3>& x) const;

  /// History of the relaxing elements, always of the same length.
  [[nodiscard]] std::vector<double> save() const;
  void load(const double* saved);
  [[nodiscard]] std::size_t history_size() const;
  [[nodiscard]] std::size_t size() const { return tets_.size(); }

 private:
  struct Element {
    Mat3 B;                  ///< inverse of the stress-free edges
    std::int32_t element;    ///< of the model
    std::int32_t past = -1;  ///< first of its entries in past_, where it relaxes
    std::int32_t retracting = -1;
  };
  struct Past {
    Mat3 s_iso = Mat3::Zero();
    Mat3 strain = Mat3::Zero();  ///< Green-Lagrange, with s_iso
    Mat3 h[4] = {Mat3::Zero(), Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
    Mat3 now = Mat3::Zero();  ///< S_past of the step under way
  };

  [[nodiscard]] Mat3 gradient(std::size_t e, const std::vector<Vec3>& x) const;
  void update_nodal_volume(const std::vector<Vec3>& x);
  [[nodiscard]] double density(std::size_t e, const Mat3& F, bool with_past) const;
  [[nodiscard]] Mat3 isochoric_stress(std::size_t e, const Mat3& F) const;
  [[nodiscard]] Mat3 stress(std::size_t e, const Mat3& F) const;
  void tet_matrix(std::size_t e, const Mat3& F, TetMatrix& K) const;
  void isotropic_matrix(std::size_t e, const Mat3& F, double pressure, double stiffness, TetMatrix& K) const;
  void general_matrix(std::size_t e, const Mat3& F, double pressure, double stiffness, TetMatrix& K) const;

  const Model& model_;
  std::vector<mesh::Tet> tets_;
  std::vector<std::int32_t> regions_;
  std::vector<double> volume_;
  std::vector<Element> elements_;
  std::vector<Mat3> rest_inverse_;  ///< of the retracting elements, in the order of elements_
  std::vector<Past> past_;
  std::vector<std::vector<material::PronyFactors>> prony_;  ///< per region, of the step under way
  std::vector<double> relaxed_;                             ///< per region: c
  std::unique_ptr<NodalVolume> nodal_;
  BlockMatrix matrix_;
  std::vector<TetMatrix> parts_;
  std::vector<double> strain_;
  std::vector<std::array<Vec3, 4>> corner_;  ///< per tet and corner: force or gradient of the volume
  double nodal_energy_ = 0;
};

}  // namespace carus::fem
