#include <algorithm>
#include <cmath>

#include "base/digits.h"
#include "base/formatted.h"
#include "fem/data_misfit.h"
#include "lint/lint.h"
#include "scene/document.h"

namespace mortier {
namespace {

constexpr size_t mostTriangles = 2000;

std::string percent(double part) {
  return digits(100 * std::min(part, 1.0)) + " %";
}

/// What a datum is off, summed over the places where it acts, and where most.
struct Sum {
  double off = 0;
  double all = 0;
  double most = 0;
  Point worst = Point::Zero();
  double time = 0;
  void add(double ofOff, double ofAll, const Point& place) {
    off += ofOff;
    all += ofAll;
    if (ofOff <= most) return;
    most = ofOff;
    worst = place;
  }
  [[nodiscard]] double part() const { return all > 0 ? off / all : 0; }
};

class DataLint {
 public:
  DataLint(const SceneDescription& scene, const Body& body, Faults& faults)
      : scene_(scene), body_(body), faults_(faults) {}

  /// Values at nodes are all that is used, or integrals.
  void onLabel(const Expression& datum, int label, bool atNodes) {
    if (datum.value.degree <= body_.degree()) return;
    Sum missed;
    Sum between;
    forEachTime(datum, [&](double t) {
      Sum ofTime;
      Sum ofNodes;
      double mean = 0;
      double square = 0;
      double length = 0;
      const TriangleMesh& mesh = body_.mesh();
      for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
        if (mesh.boundaryLabels[e] != label) continue;
        std::vector<Point> places;
        for (const int v : mesh.boundaryEdges[e]) places.push_back(mesh.vertices[v]);
        const double here = (places[1] - places[0]).norm();
        const Point middle = (places[0] + places[1]) / 2;
        const ResolvedEdge edge = onEdge(datum.value, places, t);
        ofTime.add(here * edge.uncertain, here * edge.size,
                   (1 - edge.worst) * places[0] + edge.worst * places[1]);
        std::array<double, 3> values{};
        for (const int k : {0, 1}) values[k] = datum.value(places[k].x(), places[k].y(), t);
        values[2] = datum.value(middle.x(), middle.y(), t);
        const Misfit w = interpolationMisfit(edge, values, body_.degree());
        ofNodes.add(here * w.square, 0, middle);
        mean += here * edge.mean();
        for (const auto& sample : edge.samples) square += here * sample.weight * sample.value * sample.value;
        length += here;
      }
      ofNodes.all = length > 0 ? square - mean * mean / length : 0;
      ofTime.time = ofNodes.time = t;
      if (ofTime.part() > missed.part()) missed = ofTime;
      if (ofNodes.part() > between.part()) between = ofNodes;
    });
    tellMissed(datum, missed);
    constexpr double noticeable = 0.01;  // the square of a tenth
    if (atNodes && !refinesMeshes(scene_) && between.part() > noticeable)
      report("datum-between-nodes", datum, between,
             "the values at the nodes are used: between them it is off by " +
                 percent(std::sqrt(between.part())) + " of how it varies, most at ");
  }

  void inBody(const Expression& datum) {
    if (datum.value.degree <= 1) return;
    Sum missed;
    const size_t triangles = body_.mesh().triangles.size();
    forEachTime(datum, [&](double t) {
      Sum ofTime;
      ofTime.time = t;
      for (size_t k = 0; k < triangles; k += 1 + triangles / mostTriangles) {
        std::vector<Point> x;
        for (const int v : body_.mesh().triangles[k]) x.push_back(body_.mesh().vertices[v]);
        const ResolvedTriangle triangle = onTriangle(datum.value, x, t);
        const auto& [a, b, c] = triangle.worst;
        const double area = doubleArea(body_.mesh(), static_cast<int>(k)) / 2;
        ofTime.add(area * triangle.uncertain, area * triangle.size, a * x[0] + b * x[1] + c * x[2]);
      }
      if (ofTime.part() > missed.part()) missed = ofTime;
    });
    tellMissed(datum, missed);
  }

 private:
  template <class Work>
  void forEachTime(const Expression& datum, Work work) const {
    if (!datum.inTime) return work(scene_.time.begin);
    for (const double part : {unevenPart, 1.0}) work(scene_.time.begin + part * scene_.time.duration());
  }

  void tellMissed(const Expression& datum, const Sum& missed) {
    if (missed.part() > ResolvedEdge::negligible)
      report("datum-unresolved", datum, missed,
             "it varies so fast that its integrals are uncertain by up to " + percent(missed.part()) +
                 ", most at ");
  }

  void report(const std::string& id, const Expression& datum, const Sum& sum, const std::string& what) {
    faults_.add(id, datum.where + ": " + what + formatted("[%.4g, %.4g]", sum.worst.x(), sum.worst.y()) +
                        (datum.inTime ? ", t = " + digits(sum.time, 4) : ""));
  }

  const SceneDescription& scene_;
  const Body& body_;
  Faults& faults_;
};

}  // namespace

void lintData(const SceneDescription& scene, const Model& model, Faults& faults) {
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    DataLint lint(scene, model.bodies[b], faults);
    for (const ConditionDescription& c : body.conditions)
      if (!c.point) lint.onLabel(c.value, c.label, c.kind == ConditionDescription::Kind::displacement);
    for (const std::optional<Expression>& force : body.force)
      if (force) lint.inBody(*force);
    if (body.temperature) lint.inBody(body.temperature->value);
    const auto stress = [&](const StressDescription& components) {
      for (const std::optional<Expression>& component : components)
        if (component) lint.inBody(*component);
    };
    stress(body.initialStress);
    for (const RegionDescription& region : body.regions) stress(region.initialStress);
  }
  for (const ContactDescription& contact : scene.contacts)
    if (contact.gap)
      DataLint(scene, model.bodies[bodyIndex(scene, contact.nonmortar().body)], faults)
          .onLabel(*contact.gap, contact.nonmortar().label, true);
}

}  // namespace mortier
