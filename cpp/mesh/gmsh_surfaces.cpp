// Surfaces of a geometry, asked of Gmsh in a process of its own (mesh/gmsh.cpp).
#include "base/error.h"
#include "mesh/geometry_surfaces.h"
#include "mesh/read.h"

#ifdef MORTIER_GMSH
#include <gmshc.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <map>

#include "base/archive.h"
#include "base/child_process.h"
#include "mesh/gmsh_library.h"
#endif

namespace mortier {

#ifndef MORTIER_GMSH

std::shared_ptr<const GeometrySurfaces> gmshSurfaces(const MeshSource& /*source*/) {
  return nullptr;
}

#else

template <class Archive>
void visitMembers(Archive& archive, SurfaceFoot& foot) {
  archive(foot.at, foot.normal);
}

namespace {

using Feet = std::vector<std::optional<SurfaceFoot> >;

/// In the process that has Gmsh.
class SurfacesInGmsh {
 public:
  explicit SurfacesInGmsh(const MeshSource& source) : gmsh_(source) {
    gmsh_.call<decltype(gmshOpen)>("gmshOpen", source.path.c_str());
    for (const int surface : entities()) {
      if (shapeOf(gmsh_, 2, surface) == "Plane") planes_.push_back(surface);
      for (const int curve : curvesAround(surface)) surfacesAt_[curve].push_back(surface);
    }
  }

  [[nodiscard]] const std::vector<int>& planes() const { return planes_; }

  [[nodiscard]] std::optional<SurfaceFoot> foot(int surface, const SpacePoint& x) const {
    constexpr int most = 8;
    constexpr double rounding = 1e-15;
    try {
      const SpacePoint first = closest(2, surface, x);
      Eigen::Vector2d u = parameters(surface, first);
      SpacePoint at = value(surface, u);
      for (int i = 0; i < most; ++i) {  // Gmsh's is exact to a part of the distance only
        const Eigen::Matrix<double, 3, 2> slopes = derivatives(surface, u);
        const Eigen::Vector2d step = slopes.colPivHouseholderQr().solve(x - at);
        const SpacePoint next = value(surface, u + step);
        if (!((next - x).norm() < (at - x).norm())) break;
        u += step;
        const double moved = (next - at).norm();
        at = next;
        if (moved <= rounding * at.norm()) break;
      }
      return SurfaceFoot{at, normal(surface, u)};
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  [[nodiscard]] std::optional<SpacePoint> onSharedCurve(int one, int other, const SpacePoint& x) const {
    std::optional<SpacePoint> nearest;
    for (const auto& [curve, surfaces] : surfacesAt_) {
      const auto has = [&](int surface) {
        return std::find(surfaces.begin(), surfaces.end(), surface) != surfaces.end();
      };
      if (!has(one) || !has(other)) continue;
      try {
        const SpacePoint found = closest(1, curve, x);
        if (!nearest || (found - x).norm() < (*nearest - x).norm()) nearest = found;
      } catch (const InputError&) {
        continue;
      }
    }
    return nearest;
  }

 private:
  [[nodiscard]] std::vector<int> numbersOf(const Gmsh::Array<int>& pairs) const {
    const std::vector<int> all = gmsh_.take(pairs);
    std::vector<int> numbers;
    for (size_t i = 1; i < all.size(); i += 2) numbers.push_back(std::abs(all[i]));
    return numbers;
  }

  [[nodiscard]] std::vector<int> entities() const {
    Gmsh::Array<int> pairs;
    gmsh_.call<decltype(gmshModelGetEntities)>("gmshModelGetEntities", &pairs.data, &pairs.size, 2);
    return numbersOf(pairs);
  }

  [[nodiscard]] std::vector<int> curvesAround(int surface) const {
    int own[2] = {2, surface};
    Gmsh::Array<int> pairs;
    gmsh_.call<decltype(gmshModelGetBoundary)>("gmshModelGetBoundary", own, size_t{2}, &pairs.data,
                                               &pairs.size, 0, 0, 0);
    std::vector<int> curves = numbersOf(pairs);
    std::sort(curves.begin(), curves.end());  // that of a seam is there twice
    curves.erase(std::unique(curves.begin(), curves.end()), curves.end());
    return curves;
  }

  [[nodiscard]] std::vector<double> numbers(const Gmsh::Array<double>& array, size_t count) const {
    std::vector<double> list = gmsh_.take(array);
    if (list.size() < count) throw InputError("nothing is known there");
    return list;
  }

  [[nodiscard]] SpacePoint closest(int dimension, int entity, const SpacePoint& x) const {
    Gmsh::Array<double> found;
    Gmsh::Array<double> ignored;
    SpacePoint from = x;
    gmsh_.call<decltype(gmshModelGetClosestPoint)>("gmshModelGetClosestPoint", dimension, entity, from.data(),
                                                   size_t{3}, &found.data, &found.size, &ignored.data,
                                                   &ignored.size);
    gmsh_.take(ignored);
    return SpacePoint(numbers(found, 3).data());
  }

  [[nodiscard]] Eigen::Vector2d parameters(int surface, const SpacePoint& x) const {
    Gmsh::Array<double> found;
    SpacePoint from = x;
    gmsh_.call<decltype(gmshModelGetParametrization)>("gmshModelGetParametrization", 2, surface, from.data(),
                                                      size_t{3}, &found.data, &found.size);
    return Eigen::Vector2d(numbers(found, 2).data());
  }

  [[nodiscard]] SpacePoint value(int surface, Eigen::Vector2d u) const {
    Gmsh::Array<double> found;
    gmsh_.call<decltype(gmshModelGetValue)>("gmshModelGetValue", 2, surface, u.data(), size_t{2}, &found.data,
                                            &found.size);
    return SpacePoint(numbers(found, 3).data());
  }

  [[nodiscard]] Eigen::Matrix<double, 3, 2> derivatives(int surface, Eigen::Vector2d u) const {
    Gmsh::Array<double> found;
    gmsh_.call<decltype(gmshModelGetDerivative)>("gmshModelGetDerivative", 2, surface, u.data(), size_t{2},
                                                 &found.data, &found.size);
    return Eigen::Matrix<double, 3, 2>(numbers(found, 6).data());
  }

  [[nodiscard]] SpacePoint normal(int surface, Eigen::Vector2d u) const {
    Gmsh::Array<double> found;
    gmsh_.call<decltype(gmshModelGetNormal)>("gmshModelGetNormal", surface, u.data(), size_t{2}, &found.data,
                                             &found.size);
    return SpacePoint(numbers(found, 3).data()).normalized();
  }

  Gmsh gmsh_;
  std::vector<int> planes_;
  std::map<int, std::vector<int> > surfacesAt_;  ///< by curves
};

/// What is asked of that process.
enum class Request : int { planes, feet, curve };

std::string answerTo(const SurfacesInGmsh& surfaces, const std::string& bytes) {
  ArchiveReader reader(bytes);
  int kind = 0;
  std::vector<int> numbers;
  std::vector<SpacePoint> points;
  reader(kind, numbers, points);
  ArchiveWriter writer;
  if (kind == static_cast<int>(Request::planes)) {
    std::vector<int> planes = surfaces.planes();
    writer(planes);
  } else if (kind == static_cast<int>(Request::feet)) {
    Feet feet;
    for (size_t i = 0; i < numbers.size(); ++i) feet.push_back(surfaces.foot(numbers[i], points[i]));
    writer(feet);
  } else {
    std::optional<SpacePoint> found = surfaces.onSharedCurve(numbers.at(0), numbers.at(1), points.at(0));
    writer(found);
  }
  return writer.bytes;
}

class GmshSurfaces : public GeometrySurfaces {
 public:
  explicit GmshSurfaces(MeshSource source) : source_(std::move(source)) {}

  [[nodiscard]] Feet feet(const std::vector<std::pair<int, SpacePoint> >& points) const override {
    std::vector<int> numbers;
    std::vector<SpacePoint> places;
    for (const auto& [surface, x] : points) {
      numbers.push_back(surface);
      places.push_back(x);
    }
    Feet found = ask<Feet>(Request::feet, numbers, places);
    found.resize(points.size());
    return found;
  }

  [[nodiscard]] std::optional<SpacePoint> onSharedCurve(int one, int other,
                                                        const SpacePoint& x) const override {
    return ask<std::optional<SpacePoint> >(Request::curve, {one, other}, {x});
  }

  [[nodiscard]] bool isPlane(int surface) const override {
    if (!planes_) planes_ = ask<std::vector<int> >(Request::planes, {}, {});
    return std::find(planes_->begin(), planes_->end(), surface) != planes_->end();
  }

 private:
  /// \returns nothing where Gmsh does not answer
  template <class Answer>
  Answer ask(Request kind, std::vector<int> numbers, std::vector<SpacePoint> points) const {
    if (fails_) return {};
    try {
      if (!server_) start();
      ArchiveWriter writer;
      int number = static_cast<int>(kind);
      writer(number, numbers, points);
      const std::string bytes = server_->ask(writer.bytes, gmshPatience);
      ArchiveReader reader(bytes);
      Answer answer{};
      reader(answer);
      return answer;
    } catch (const InputError&) {
      fails_ = true;
      server_.reset();
      return {};
    }
  }

  void start() const {
    const auto begin = [&]() -> ChildServer::Answers {
      auto surfaces = std::make_shared<const SurfacesInGmsh>(source_);
      return [surfaces](const std::string& request) { return answerTo(*surfaces, request); };
    };
    server_ = std::make_unique<ChildServer>(begin, source_.path + ": Gmsh");
  }

  MeshSource source_;
  mutable std::unique_ptr<ChildServer> server_;
  mutable std::optional<std::vector<int> > planes_;
  mutable bool fails_ = false;
};

}  // namespace

std::shared_ptr<const GeometrySurfaces> gmshSurfaces(const MeshSource& source) {
  return std::make_shared<const GmshSurfaces>(source);
}

#endif

}  // namespace mortier
