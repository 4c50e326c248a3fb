// Whether bodies overlap where no contact holds them apart: their boundaries as moved are intersected,
// without the rows of contact (contact/overlap.h). An overlap is explained by
//
//   - the residual that a solution is allowed;
//   - what is drawn or asked for: a distance that is given, bodies that touch at once although they overlap
//     as drawn, overlaps as drawn of labels without contact, chords of reentrant curves;
//   - small sliding: rows keep the directions as drawn, which is off by the slip times the angle between
//     those and the lines as moved;
//   - meshes, but only near a row that presses: lines in contact are off each other between its nodes, by a
//     part of the element times the turns of the lines within it.
//
// docs/sliding.md has the factors, and what they are on sound scenes.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "contact/overlap.h"
#include "contact/space_overlap.h"
#include "solver/model.h"
#include "time/report.h"

namespace mortier {

class OverlapCheck {
 public:
  explicit OverlapCheck(const Model& model);

  /// The deepest overlap, one that is not explained first.
  /// \param u  displacements of the bodies
  /// \param force  per interface, nodal contact forces
  /// \param residual  of a solution that is allowed, over the extent of the bodies
  [[nodiscard]] BodyOverlap find(const std::vector<Vector>& u, const std::vector<Vector>& force, double time,
                                 double residual) const;

 private:
  /// A point of the boundary of a body within another, and how deep it may be there.
  struct Sample {
    std::array<int, 2> bodies{};  ///< the one whose boundary it is of first
    std::array<int, 2> labels{};
    SpacePoint at{0, 0, 0};
    double depth = 0;
    double size = 0;                    ///< of the larger element there [m]
    double nonmortar = 0;               ///< of that of the nonmortar side [m]
    double always = 0;                  ///< what explains it anywhere [m]
    double pressed = 0;                 ///< what does so near a row that presses [m]
    std::array<SpacePoint, 2> drawn{};  ///< the same points of both bodies as drawn
  };
  struct Region {
    double area = 0;
    std::vector<Sample> samples;
  };
  /// What of an interface lies between two bodies.
  struct Between {
    const ContactInterface* interface = nullptr;
    size_t number = 0;
    std::vector<SpacePoint> pressing;  ///< places of nodes that press
    /// By nodes of the nonmortar body that overlap by what is asked for: by how much [m].
    std::vector<std::pair<int, double>> asked;
  };
  struct Places;

  /// Contacts of two bodies at a point of the boundary of one.
  struct AtPoint {
    double asked = 0;      ///< overlap that is asked for there [m]
    double nonmortar = 0;  ///< size of the nonmortar element; 0 without a contact [m]
    bool named = false;    ///< whether a contact names both labels
  };
  /// \param labels, sizes, nodes  of the elements of the point's own body and of the other one
  static AtPoint atPoint(const std::vector<Between>& contacts, size_t own, const std::array<int, 2>& labels,
                         const std::array<double, 2>& sizes, const std::array<std::array<int, 3>, 2>& nodes);
  [[nodiscard]] const Body& body(size_t b) const;
  [[nodiscard]] bool turnsOver(size_t b, const Places& places) const;
  [[nodiscard]] std::vector<Between> between(size_t one, size_t other, const Places& places,
                                             const std::vector<Vector>& force, double time) const;
  [[nodiscard]] std::vector<Region> inPlane(size_t one, size_t other, const Places& places,
                                            const std::vector<Between>& contacts) const;
  [[nodiscard]] std::vector<Region> inSpace(size_t one, size_t other, const Places& places,
                                            const std::vector<Between>& contacts) const;
  /// Of the curved surfaces of contacts, by their rows, which may not press although the surfaces overlap
  /// between the nodes: one region for each contact in which they do.
  [[nodiscard]] std::vector<Region> behindMeshes(const std::vector<Between>& contacts, const Places& places,
                                                 const std::vector<Vector>& u, double time) const;
  [[nodiscard]] bool drawnOnly(size_t b, int label) const;
  void dropTied(const Places& places, std::vector<Sample>& samples) const;
  void judge(const Region& region, const std::vector<Between>& contacts, BodyOverlap& worst) const;

  const Model& model_;
  std::vector<BodyOutline> outlines_;
  std::vector<MovedOutline> drawn_;
  std::vector<SpaceOutline> spaceOutlines_;
  std::vector<MovedSurface> spaceDrawn_;
  /// By ties, of both bodies: the nodes that their rows act on.
  std::vector<std::map<size_t, std::vector<int>>> tiedNodes_;
  std::vector<Vector>
      distanceDrawn_;  ///< per interface and row, of the boundaries; negative in the other body
};

}  // namespace mortier
