#include "report/fields.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>

#include "base/error.h"
#include "base/formatted.h"
#include "material/stress.h"
#include "report/manifest.h"
#include "report/result_files.h"
#include "solver/state.h"

namespace mortier {

namespace {

/// A .vtu file: the arrays are described first, their bytes follow in one appended block, the last array
/// first: meshio renames offsets as it reads and must not meet a new one before an old one of the same value.
class VtuFile {
 public:
  explicit VtuFile(std::string path) : path_(std::move(path)), file_(path_) {
    static_assert(std::endian::native == std::endian::little);
    xml_ << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  }

  void open(const std::string& tag, const std::string& attributes = "") {
    xml_ << '<' << tag << (attributes.empty() ? "" : " ") << attributes << ">\n";
  }
  void shut(const std::string& tag) { xml_ << "</" << tag << ">\n"; }

  void array(const std::string& name, std::vector<double> values, int components,
             const std::vector<std::string>& componentNames = {}) {
    if (!Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size())).allFinite())
      throw OutputError(path_.substr(path_.rfind('/') + 1) + ": " + name +
                        " is not finite everywhere; the run is not valid");
    describe("Float64", name, components, componentNames);
    append(values.data(), values.size() * sizeof(double));
  }
  template <class Integer>
  void integers(const std::string& type, const std::string& name, const std::vector<Integer>& values) {
    describe(type, name, 1, {});
    append(values.data(), values.size() * sizeof(Integer));
  }

  FileRecord close() {
    uint64_t offset = 0;
    for (const std::string& array : arrays_) offset += array.size();
    for (size_t i = 0; i < arrays_.size(); ++i) {
      offset -= arrays_[i].size();
      file_ << descriptions_[i] << " format=\"appended\" offset=\"" << offset << "\"/>\n";
    }
    file_ << xml_.str() << "</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    std::for_each(arrays_.rbegin(), arrays_.rend(), [&](const std::string& array) { file_ << array; });
    file_ << "\n</AppendedData>\n</VTKFile>\n";
    return file_.close();
  }

 private:
  void describe(const std::string& type, const std::string& name, int components,
                const std::vector<std::string>& componentNames) {
    xml_ << "<DataArray type=\"" << type << "\" Name=\"" << name << '"';
    if (components > 1) {  // a scalar says nothing, so that readers give it back without a second dimension
      xml_ << " NumberOfComponents=\"" << components << '"';
    }
    for (size_t c = 0; c < componentNames.size(); ++c)
      xml_ << " ComponentName" << c << "=\"" << componentNames[c] << '"';
    descriptions_.push_back(xml_.str());
    xml_.str("");
  }
  void append(const void* data, uint64_t size) {
    std::string& bytes = arrays_.emplace_back();
    bytes.reserve(sizeof size + size);
    bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes.append(static_cast<const char*>(data), size);
  }

  std::string path_;
  OutputFile file_;
  std::ostringstream xml_;                 ///< since the last array
  std::vector<std::string> descriptions_;  ///< all up to an array, and its own but for the offset
  std::vector<std::string> arrays_;
};

std::vector<double> flat(const Matrix& m) {
  return {m.data(), m.data() + m.size()};
}

void writePoints(VtuFile& file, const Body& body, const Vector& displacement, const ContactOfNodes& contact) {
  std::vector<double> points;
  std::vector<double> u;
  points.reserve(3 * static_cast<size_t>(body.nodes()));
  u.reserve(points.capacity());
  const int dimension = body.dimension();
  for (int v = 0; v < body.nodes(); ++v) {
    const SpacePoint place = body.placeOfNode(v);
    points.insert(points.end(), place.begin(), place.end());
    for (int c = 0; c < 3; ++c) u.push_back(c < dimension ? displacement[dimension * v + c] : 0.0);
  }
  file.open("Points");
  file.array("Points", std::move(points), 3);
  file.shut("Points");
  file.open("PointData", "Vectors=\"displacement\"");
  file.array("displacement", std::move(u), 3);
  if (!contact.gap.empty()) {
    file.array("contact_pressure", contact.pressure, 1);
    file.array("gap", contact.gap, 1);
    file.integers("UInt8", "nonmortar", contact.has);
  }
  file.shut("PointData");
}

/// Nodes in the middle of a side whose two ends have a value get the mean of both.
void fillMiddles(const Body& body, std::vector<double>& values) {
  if (body.degree() == 1) return;
  constexpr std::array<std::array<int, 2>, 6> ends{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  const size_t corners = body.dimension() + 1;
  const size_t sides = corners * (corners - 1) / 2;
  const std::vector<int>& nodes = body.nodesOfElements();
  for (size_t first = 0; first < nodes.size(); first += corners + sides)
    for (size_t side = 0; side < sides; ++side) {
      double& middle = values[nodes[first + corners + side]];
      const double mean = (values[nodes[first + ends[side][0]]] + values[nodes[first + ends[side][1]]]) / 2;
      if (std::isnan(middle)) middle = mean;
    }
}

/// Of a node on two nonmortar sides the larger pressure and the smaller gap.
std::vector<ContactOfNodes> contactOfNodes(const Model& model, const State& state) {
  std::vector<ContactOfNodes> found(model.bodies.size());
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactFields fields = contactFields(model, state, k);
    const int b = model.interfaces[k].pair().nonmortar.body;
    ContactOfNodes& of = found[b];
    const std::vector<double> none(model.bodies[b].nodes(), std::numeric_limits<double>::quiet_NaN());
    if (of.gap.empty()) of = {none, none, {}};
    for (size_t i = 0; i < fields.vertex.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      double& pressure = of.pressure[fields.vertex[i]];
      double& gap = of.gap[fields.vertex[i]];
      pressure = std::isnan(pressure) ? fields.pressure[row] : std::max(pressure, fields.pressure[row]);
      gap = std::isnan(gap) ? fields.gap[row] : std::min(gap, fields.gap[row]);
    }
  }
  for (size_t b = 0; b < found.size(); ++b)
    for (std::vector<double>* values : {&found[b].pressure, &found[b].gap}) {
      if (values->empty()) continue;
      fillMiddles(model.bodies[b], *values);
      found[b].has.clear();
      for (double& value : *values) {
        found[b].has.push_back(std::isnan(value) ? 0 : 1);
        if (std::isnan(value)) value = 0;
      }
    }
  return found;
}

/// VTK numbers the nodes of its quadratic cells as ours.
void writeCells(VtuFile& file, const Body& body) {
  constexpr uint8_t vtkTriangle = 5;
  constexpr uint8_t vtkQuadraticTriangle = 22;
  constexpr uint8_t vtkTetrahedron = 10;
  constexpr uint8_t vtkQuadraticTetrahedron = 24;
  const bool space = body.dimension() == 3;
  const std::vector<int>& nodes = body.nodesOfElements();
  const std::vector<int32_t> connectivity(nodes.begin(), nodes.end());
  const size_t perCell = connectivity.size() / body.elements();
  std::vector<int32_t> offsets(body.elements());
  for (size_t t = 0; t < offsets.size(); ++t) offsets[t] = static_cast<int32_t>((t + 1) * perCell);
  const uint8_t linear = space ? vtkTetrahedron : vtkTriangle;
  const uint8_t quadratic = space ? vtkQuadraticTetrahedron : vtkQuadraticTriangle;
  file.open("Cells");
  file.integers("Int32", "connectivity", connectivity);
  file.integers("Int32", "offsets", offsets);
  file.integers("UInt8", "types",
                std::vector<uint8_t>(offsets.size(), body.degree() == 1 ? linear : quadratic));
  file.shut("Cells");
}

void writeCellData(VtuFile& file, const Body& body, const BodyState& state, const ErrorEstimate& estimate) {
  if (body.rigid()) {
    file.open("CellData");
    file.integers("Int32", "region", body.regions());
    file.shut("CellData");
    return;
  }
  const CellFields fields = cellFields(body, state);
  file.open("CellData", "Scalars=\"von_mises\"");
  const auto components = static_cast<int>(fields.stress.rows());
  const auto named = [&](const std::string& letter) {
    std::vector<std::string> names = components == 6
                                         ? std::vector<std::string>{"11", "22", "33", "12", "23", "13"}
                                         : std::vector<std::string>{"11", "22", "12", "33"};
    names.resize(components);
    for (std::string& name : names) name.insert(0, letter);
    return names;
  };
  file.array("stress", flat(fields.stress), components, named("s"));
  if (fields.stressAtPoints.rows() > components)
    file.array("stress_at_points", flat(fields.stressAtPoints),
               static_cast<int>(fields.stressAtPoints.rows()));
  file.array("von_mises", flat(fields.vonMises), 1);
  file.array("viscoplastic_strain", flat(fields.viscoplasticStrain), components, named("e"));
  file.integers("Int32", "viscoplastic", fields.viscoplastic);
  file.integers("Int32", "region", body.regions());
  const double energy = estimate.energy > 0 ? estimate.energy : 1;
  file.array("error", flat((estimate.error / energy).cwiseSqrt()), 1);
  file.shut("CellData");
}

/// (p, q, r) or (p, q, r, s33) by the axes; in space s11, s22, s33, s12, s23, s13.
PointVector allCartesian(PointVector s) {
  if (s.size() == 6) {
    const SpaceStress c = toSpaceCartesian(SpaceStress(s.head<6>()));
    s.head<6>() << c[0], c[1], c[2], c[3], c[5], c[4];
    return s;
  }
  s.head<3>() = toCartesian(s.head<3>());
  return s;
}

}  // namespace

CellFields cellFields(const Body& body, const BodyState& state) {
  const auto cells = static_cast<Eigen::Index>(body.elements());
  const Eigen::Index pointsPerCell = std::max<Eigen::Index>(1, state.stress.cols() / cells);  // of a tool 0
  const Eigen::Index components = body.material().tensorComponents();
  const Matrix strain = strainOfLaw(body.material(), state);
  CellFields fields{Matrix::Zero(components, cells), Matrix(components * pointsPerCell, cells),
                    Vector::Zero(cells), Matrix::Zero(components, cells), std::vector<int>(cells, 0)};
  const double weight = 1.0 / static_cast<double>(pointsPerCell);
  for (Eigen::Index point = 0; point < state.stress.cols(); ++point) {
    const Eigen::Index cell = point / pointsPerCell;
    const PointVector stress = allCartesian(state.stress.col(point).head(components));
    fields.stress.col(cell) += weight * stress;
    fields.stressAtPoints.col(cell).segment(components * (point % pointsPerCell), components) = stress;
    fields.vonMises[cell] += weight * vonMises(state.stress.col(point).head(components));
    fields.viscoplasticStrain.col(cell) +=
        weight * allCartesian(state.viscoplasticStrain.col(point).head(components));
    if (body.material().flows(state.stress, static_cast<int>(point), &strain)) fields.viscoplastic[cell] = 1;
  }
  return fields;
}

std::string fieldName(const std::string& body, int step) {
  return body + formatted("_%06d.vtu", step);
}

void Fields::write(const State& state, const std::vector<ErrorEstimate>& estimates,
                   const std::vector<ContactOfNodes>& contact, KeptFields& kept) {
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    const std::string name = fieldName(body.name(), kept.step);
    VtuFile file(folder_ + "/" + name);
    file.open("Piece", "NumberOfPoints=\"" + std::to_string(body.nodes()) + "\" NumberOfCells=\"" +
                           std::to_string(body.elements()) + "\"");
    writePoints(file, body, body.moved(state.bodies[b].displacement), contact[b]);
    writeCells(file, body);
    writeCellData(file, body, state.bodies[b], estimates[b]);
    file.shut("Piece");
    kept.files[name] = file.close();
  }
}

void Fields::wait() {
  if (writing_.valid()) writing_.get();
}

void Fields::add(const State& state, int step) {
  constexpr int trianglesWorthAThread = 20000;
  size_t triangles = 0;
  for (const Body& body : model_.bodies) triangles += body.elements();
  wait();
  kept_.push_back({step, state.time, {}});  // the next one waits until this one is written
  if (triangles < trianglesWorthAThread)
    write(state, *error_.estimates(), contactOfNodes(model_, state), kept_.back());
  else  // contact is evaluated here: rows change as the run goes on
    writing_ = std::async(std::launch::async, [this, state, estimates = error_.estimates(),
                                               contact = contactOfNodes(model_, state)] {
      write(state, *estimates, contact, kept_.back());
    });
}

const std::vector<KeptFields>& Fields::sync() {
  wait();
  for (; synced_ < kept_.size(); ++synced_)
    for (const auto& [name, record] : kept_[synced_].files)
      OutputFile(std::string(folder_).append("/").append(name), record).sync();
  return kept_;
}

std::map<std::string, FileRecord> Fields::close() {
  wait();
  std::map<std::string, FileRecord> written;
  OutputFile file(folder_ + "/fields.pvd");
  file << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
          "byte_order=\"LittleEndian\">\n"
          "<Collection>\n";
  for (const KeptFields& kept : kept_)
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      file << "<DataSet timestep=\"" << formatted("%.17g", kept.time) << "\" group=\"\" part=\"" << b
           << "\" name=\"" << model_.bodies[b].name() << "\" file=\""
           << fieldName(model_.bodies[b].name(), kept.step) << "\"/>\n";
    }
  file << "</Collection>\n</VTKFile>\n";
  for (const KeptFields& kept : kept_) written.insert(kept.files.begin(), kept.files.end());
  written["fields.pvd"] = file.close();
  return written;
}

}  // namespace mortier
