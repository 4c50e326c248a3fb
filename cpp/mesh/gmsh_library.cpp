#ifdef MORTIER_GMSH
#include "mesh/gmsh_library.h"

#include <dlfcn.h>
#include <gmshc.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <type_traits>

#include "base/error.h"
#include "base/whole_file.h"

namespace mortier {
namespace {

std::string decimal(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace

Gmsh::Gmsh(const MeshSource& source) : path_(source.path) {
  library_ = dlopen(MORTIER_GMSH, RTLD_NOW);
  if (library_ == nullptr) throw InputError(path_ + ": Gmsh cannot be loaded: " + dlerror());
  // Later versions have an argument for runs as a program.
  std::vector<std::string> words{"gmsh"};
  for (const auto& [name, value] : source.parameters)
    words.insert(words.end(), {"-setnumber", name, decimal(value)});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  const int count = static_cast<int>(arguments.size());
  if constexpr (std::is_invocable_v<decltype(gmshInitialize), int, char**, int, int*>)
    call<decltype(gmshInitialize)>("gmshInitialize", count, arguments.data(), 0);
  else
    call<decltype(gmshInitialize)>("gmshInitialize", count, arguments.data(), 0, 0);
  call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", "General.Terminal", 0.0);
  if (source.size > 0)
    call<decltype(gmshOptionSetNumber)>("gmshOptionSetNumber", "Mesh.MeshSizeMax", source.size);
}

Gmsh::~Gmsh() {
  int ignored = 0;
  reinterpret_cast<decltype(gmshFinalize)*>(address("gmshFinalize"))(&ignored);
}

void* Gmsh::address(const char* name) const {
  void* const found = dlsym(library_, name);
  if (found == nullptr) throw InputError(path_ + ": Gmsh lacks " + name);
  return found;
}

void Gmsh::free(void* data) const {
  reinterpret_cast<decltype(gmshFree)*>(address("gmshFree"))(data);
}

void Gmsh::fail() const {
  char* text = nullptr;
  int error = 0;
  reinterpret_cast<decltype(gmshLoggerGetLastError)*>(address("gmshLoggerGetLastError"))(&text, &error);
  std::string said = text == nullptr || *text == 0 ? "cannot read it" : text;
  std::replace(said.begin(), said.end(), '\n', ' ');
  if (text != nullptr) free(text);
  throw InputError(path_ + ": Gmsh: " + said);
}

std::string shapeOf(const Gmsh& gmsh, int dimension, int entity) {
  char* type = nullptr;
  gmsh.call<decltype(gmshModelGetType)>("gmshModelGetType", dimension, entity, &type);
  std::string word = type == nullptr ? "" : type;
  if (type != nullptr) gmsh.take(Gmsh::Array<char>{type, 0});
  return word.find("Discrete") != std::string::npos ? "" : word;
}

namespace {

const Point unknownPoint = Point::Constant(std::numeric_limits<double>::quiet_NaN());

/// The point of a curve nearest to the middle of one of its edges; none where Gmsh finds none near it.
Point middleOn(const Gmsh& gmsh, int curve, double z, const Point& a, const Point& b) {
  const Point half = (b - a) / 2;
  std::array<double, 3> middle{a.x() + half.x(), a.y() + half.y(), z};
  Gmsh::Array<double> found;
  Gmsh::Array<double> parameter;
  gmsh.call<decltype(gmshModelGetClosestPoint)>("gmshModelGetClosestPoint", 1, curve, middle.data(),
                                                middle.size(), &found.data, &found.size, &parameter.data,
                                                &parameter.size);
  const std::vector<double> x = gmsh.take(found);
  gmsh.take(parameter);
  if (x.size() < 3) return unknownPoint;
  const Point point(x[0], x[1]);
  return (point - a - half).norm() < half.norm() ? point : unknownPoint;
}

/// A curve of Gmsh by its parameter.
class GmshCurve {
 public:
  GmshCurve(const Gmsh& gmsh, int curve) : gmsh_(&gmsh), curve_(curve) {
    Gmsh::Array<double> least;
    Gmsh::Array<double> largest;
    gmsh.call<decltype(gmshModelGetParametrizationBounds)>("gmshModelGetParametrizationBounds", 1, curve,
                                                           &least.data, &least.size, &largest.data,
                                                           &largest.size);
    const std::vector<double> from = gmsh.take(least);
    const std::vector<double> to = gmsh.take(largest);
    if (from.empty() || to.empty() || !(from[0] < to[0])) return;
    begin_ = from[0];
    end_ = to[0];
    setSize();
    findParameters();
  }

  /// Of an edge between two nodes; none where its nodes are not on the curve, or where it is not found.
  [[nodiscard]] EdgeCurve between(size_t tag0, const Point& x0, size_t tag1, const Point& x1) const {
    const std::optional<double> first = parameter(tag0, x0, begin_, end_);
    const std::optional<double> last = parameter(tag1, x1, end_, begin_);
    if (!first || !last) return {};
    const double u0 = *first;
    const double u1 = *last;
    const std::vector<Point> ends = points({u0, u1});
    const Point off0 = x0 - ends[0];  // a CAD file has its vertices on its curves to 1e-7
    const Point off1 = x1 - ends[1];
    const auto onCurve = [&](const std::vector<double>& t) {
      std::vector<double> u;
      u.reserve(t.size());
      for (const double part : t) u.push_back((1 - part) * u0 + part * u1);
      std::vector<Point> x = points(u);
      for (size_t i = 0; i < x.size(); ++i) x[i] += (1 - t[i]) * off0 + t[i] * off1;
      if (t.front() == 0) x.front() = x0;
      if (t.back() == 1) x.back() = x1;
      return x;
    };
    SampledCurve curve = sampled(onCurve, tolerance_);
    if (curve.points.empty()) return {};
    return {std::make_shared<const SampledCurve>(std::move(curve))};
  }

 private:
  [[nodiscard]] std::vector<Point> points(std::vector<double> u) const {
    Gmsh::Array<double> coordinates;
    gmsh_->call<decltype(gmshModelGetValue)>("gmshModelGetValue", 1, curve_, u.data(), u.size(),
                                             &coordinates.data, &coordinates.size);
    const std::vector<double> x = gmsh_->take(coordinates);
    std::vector<Point> result(u.size(), unknownPoint);
    for (size_t i = 0; 3 * i + 2 < x.size(); ++i) result[i] = {x[3 * i], x[3 * i + 1]};
    return result;
  }

  void setSize() {
    constexpr int parts = 32;
    constexpr double fine = 1e-11;      // of the size
    constexpr double rounding = 1e-14;  // of the coordinates
    std::vector<double> u;
    for (int i = 0; i <= parts; ++i) u.push_back(begin_ + (end_ - begin_) * i / parts);
    double largest = 0;
    for (const std::vector<Point> x = points(u); const Point& point : x) {
      size_ = std::max(size_, (point - x.front()).norm());
      largest = std::max(largest, point.cwiseAbs().maxCoeff());
    }
    tolerance_ = fine * size_ + rounding * largest;
  }

  void findParameters() {
    Gmsh::Array<size_t> tags;
    Gmsh::Array<double> coordinates;
    Gmsh::Array<double> parameters;
    gmsh_->call<decltype(gmshModelMeshGetNodes)>("gmshModelMeshGetNodes", &tags.data, &tags.size,
                                                 &coordinates.data, &coordinates.size, &parameters.data,
                                                 &parameters.size, 1, curve_, 0, 1);
    const std::vector<size_t> tag = gmsh_->take(tags);
    gmsh_->take(coordinates);
    const std::vector<double> u = gmsh_->take(parameters);
    for (size_t i = 0; i < std::min(tag.size(), u.size()); ++i) parameters_[tag[i]] = u[i];
  }

  /// Nodes at the ends of the curve have none of their own: that of the end at which they are.
  [[nodiscard]] std::optional<double> parameter(size_t tag, const Point& x, double first,
                                                double second) const {
    constexpr double onCurve = 1e-6;
    const auto found = parameters_.find(tag);
    const std::vector<double> candidates =
        found != parameters_.end() ? std::vector<double>{found->second} : std::vector<double>{first, second};
    for (const double u : candidates)
      if ((points({u}).front() - x).norm() <= onCurve * size_) return u;
    return std::nullopt;
  }

  const Gmsh* gmsh_;
  int curve_;
  double begin_ = 0;
  double end_ = 0;
  double size_ = 0;       // [m]
  double tolerance_ = 0;  // of points [m]
  std::map<size_t, double> parameters_;
};

/// None where Gmsh has no parameter for it.
std::optional<GmshCurve> curveOf(const Gmsh& gmsh, int curve) {
  try {
    return GmshCurve(gmsh, curve);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Whether the curve is its chord, as far as that matters.
bool isStraight(const SampledCurve& curve) {
  constexpr double straight = 1e-9;
  const Point& a = curve.points.front();
  const Point chord = curve.points.back() - a;
  return std::all_of(curve.points.begin(), curve.points.end(), [&](const Point& x) {
    const Point from = x - a;
    return std::abs(cross(chord, from)) <= straight * chord.squaredNorm();
  });
}

}  // namespace

std::vector<KnownEdge> knownEdges(const Gmsh& gmsh, int curve, const std::vector<size_t>& ends,
                                  const PlaneNodes& nodes) {
  std::vector<KnownEdge> edges(ends.size() / 2, {unknownPoint});
  const std::string shape = shapeOf(gmsh, 1, curve);
  if (shape.empty()) return edges;
  std::optional<GmshCurve> byParameter =
      shape == "Circle" || shape == "Line" ? std::nullopt : curveOf(gmsh, curve);
  for (size_t e = 0; e < edges.size(); ++e) {
    const Point& a = nodes.at.at(ends[2 * e]);
    const Point& b = nodes.at.at(ends[2 * e + 1]);
    if (shape == "Line") {
      edges[e].middle = (a + b) / 2;
      continue;
    }
    edges[e].middle = middleOn(gmsh, curve, nodes.z, a, b);
    if (!byParameter) continue;
    const EdgeCurve found = byParameter->between(ends[2 * e], a, ends[2 * e + 1], b);
    if (!found.known()) byParameter.reset();  // nor are the others
    if (!found.known()) continue;
    if (isStraight(*found.curve)) {
      edges[e].middle = (a + b) / 2;
      continue;
    }
    const Point middle = found.at(found.middle());
    if (!((middle - (a + b) / 2).norm() < (b - a).norm() / 2)) continue;
    edges[e] = {middle, found};
  }
  return edges;
}

namespace {

/// The names before "=" in the brackets of every DefineConstant[...].
std::set<std::string> constantsIn(const std::string& text) {
  constexpr const char* blank = " \t\r\n\v\f";
  const std::string keyword = "DefineConstant";
  std::set<std::string> names;
  for (size_t at = 0; (at = text.find(keyword, at)) != std::string::npos;) {
    const size_t open = text.find_first_not_of(blank, at += keyword.size());
    const size_t close = text.find(']', at);
    if (open == std::string::npos || close == std::string::npos || text[open] != '[') continue;
    for (size_t equals = text.find('=', open); equals < close; equals = text.find('=', equals + 1)) {
      const size_t end = text.find_last_not_of(blank, equals - 1) + 1;
      size_t begin = end;
      while (std::isalnum(static_cast<unsigned char>(text[begin - 1])) != 0 || text[begin - 1] == '_')
        --begin;
      while (begin < end && std::isdigit(static_cast<unsigned char>(text[begin])) != 0) ++begin;
      if (begin < end) names.insert(text.substr(begin, end - begin));
    }
  }
  return names;
}

}  // namespace

void requireConstants(const MeshSource& source) {
  if (source.parameters.empty()) return;
  const std::set<std::string> known = constantsIn(readWhole(source.path, "a geometry"));
  for (const auto& [name, value] : source.parameters)
    if (known.count(name) == 0) {
      std::string list;
      for (const std::string& each : known) list += (list.empty() ? "" : ", ") + each;
      throw InputError(source.path + ": no constant " + name + ", expected " +
                       (list.empty() ? "a geometry with DefineConstant[...]"
                                     : "one that its DefineConstant names: " + list));
    }
}

}  // namespace mortier

#endif
