#include "report/result_files.h"

#include <filesystem>
#include <functional>
#include <utility>

#include "base/error.h"

namespace mortier {

void removeFields(const std::string& folder, const FilesSoFar& files, const FilesSoFar& kept) {
  std::error_code none;  // what stays is no part of the result
  for (size_t i = kept.fields.size(); i < files.fields.size(); ++i)
    for (const auto& [name, record] : files.fields[i].files)
      std::filesystem::remove(std::filesystem::path(folder) / name, none);
}

namespace {

/// What it does to a file and its copy. \throws OutputError
template <class Does>
void withCopies(const std::string& folder, const std::map<std::string, FileRecord>& files, Does does) {
  for (const auto& [name, record] : files) {
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    std::error_code error;
    does(path, path.string() + keptSuffix, error);
    if (error) throw OutputError(path.string() + ": cannot be kept: " + error.message());
  }
}

}  // namespace

void keepAside(const std::string& folder, const std::map<std::string, FileRecord>& files) {
  withCopies(folder, files, [](const auto& path, const auto& copy, std::error_code& error) {
    std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing, error);
  });
}

void bringBack(const std::string& folder, const std::map<std::string, FileRecord>& files) {
  withCopies(folder, files, [](const auto& path, const auto& copy, std::error_code& error) {
    std::filesystem::rename(copy, path, error);
  });
}

ResultFiles::ResultFiles(const std::string& folder, const Model& model, CurrentMeshError& error,
                         const std::vector<Quantity>& quantities, const Units& units)
    : model_(model),
      history_(folder + "/history.csv"),
      contact_(folder + "/contact.csv"),
      fields_(folder, model, error),
      lastKept_(-1) {
  writeHistoryHeader(history_, historyColumns(model, quantities, units));
  writeContactHeader(contact_, model);
}

ResultFiles::ResultFiles(const std::string& folder, const Model& model, CurrentMeshError& error,
                         const FilesSoFar& soFar)
    : model_(model),
      history_(folder + "/history.csv", soFar.history),
      contact_(folder + "/contact.csv", soFar.contact),
      fields_(folder, model, error, soFar.fields),
      lastKept_(soFar.fields.empty() ? -1 : soFar.fields.back().step) {}

void ResultFiles::add(const State& state, const StepReport& report, bool kept) {
  if (hasRow(report)) writeHistoryRow(history_, report);
  if (kept) keep(state, report.step);
}

void ResultFiles::keep(const State& state, int step) {
  fields_.add(state, step);
  writeContactRows(contact_, model_, state, step);
  lastKept_ = step;
}

FilesSoFar ResultFiles::sync() {
  return {history_.sync(), contact_.sync(), fields_.sync()};
}

std::map<std::string, FileRecord> ResultFiles::close(const State& state, int lastStep) {
  if (lastKept_ != lastStep) keep(state, lastStep);
  std::map<std::string, FileRecord> written = fields_.close();
  written["history.csv"] = history_.close();
  written["contact.csv"] = contact_.close();
  return written;
}

namespace {

struct Column {
  const char* name;
  std::function<std::string(const Units&)> unit;  ///< none of a number without
  std::function<HistoryValue(const StepReport&)> value;
};

/// Those that every history has.
const std::vector<Column>& columnsOfSteps() {
  const auto residual = [](double Certificate::*member) {
    return [member](const StepReport& r) { return HistoryValue(r.certificate.*member); };
  };
  using R = StepReport;
  static const std::vector<Column> columns{
      {"step", {}, &R::step},
      {"time", &Units::time, &R::time},
      {"time_step", &Units::time, &R::timeStep},
      {"estimate", {}, &R::estimate},
      {"rejections", {}, &R::rejections},
      {"guarded", {}, [](const R& r) { return r.guarded ? 1 : 0; }},
      {"rung", {}, [](const R& r) { return std::string_view(nameOf(r.method)); }},
      {"iterations", {}, &R::iterations},
      {"factorisations", {}, &R::factorisations},
      {"active", {}, &R::active},
      {"joined", {}, &R::joined},
      {"left", {}, &R::left},
      {"penetration", &Units::penetration, &R::penetration},
      {"max_pressure", &Units::stress, &R::maxPressure},
      {"contact_force", &Units::forcePerDepth, &R::contactForce},
      {"contact_resultant_x", &Units::forcePerDepth, &R::resultantX},
      {"contact_resultant_y", &Units::forcePerDepth, &R::resultantY},
      {"von_mises_max", &Units::stress, &R::vonMises},
      {"displacement_max", &Units::length, &R::displacement},
      {"elastic_energy", &Units::energyPerDepth, &R::energy},
      {"viscoplastic_fraction", {}, &R::viscoplasticFraction},
      {"force_balance", {}, residual(&Certificate::forceBalance)},
      {"material_residual", {}, residual(&Certificate::materialResidual)},
      {"gap_on_active", {}, residual(&Certificate::gapOnActive)},
      {"sign", {}, residual(&Certificate::sign)},
      {"complementarity", {}, residual(&Certificate::complementarity)},
      {"open_penetration", {}, residual(&Certificate::openPenetration)},
      {"rounding", {}, residual(&Certificate::rounding)}};
  return columns;
}

template <class Values, class Write>
void writeLine(OutputFile& file, const Values& values, Write write) {
  const char* comma = "";
  for (const auto& value : values) {
    file << comma;
    write(value);
    comma = ",";
  }
  file << '\n';
}

}  // namespace

std::vector<std::string> historyColumns(const Model& model, const std::vector<Quantity>& quantities,
                                        const Units& units) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, const std::string& unit) {
    names.push_back(name + '[' + unit + ']');
  };
  for (const Column& each : columnsOfSteps())
    if (each.unit)
      add(each.name, each.unit(units));
    else
      names.emplace_back(each.name);
  if (model.bodies.front().dimension() == 3) add("contact_resultant_z", units.forcePerDepth());
  if (anyFriction(model)) names.emplace_back("ambiguous");
  for (size_t k = 0; k < model.interfaces.size(); ++k)
    if (model.interfaces[k].hasFriction()) add("friction_work_" + std::to_string(k), units.energyPerDepth());
  for (const Quantity& quantity : quantities) add(quantity.name, quantity.unit(units));
  return names;
}

std::vector<HistoryValue> historyRow(const StepReport& r) {
  std::vector<HistoryValue> row;
  for (const Column& each : columnsOfSteps()) row.push_back(each.value(r));
  if (r.resultantZ) row.emplace_back(*r.resultantZ);
  if (!r.frictionWork.empty()) row.emplace_back(r.solutions.ambiguous ? 1 : 0);
  row.insert(row.end(), r.frictionWork.begin(), r.frictionWork.end());
  row.insert(row.end(), r.quantities.begin(), r.quantities.end());
  return row;
}

namespace {

/// Leaves out nodes that face nothing now.
void keepFacing(const ContactInterface& interface, ContactFields& fields) {
  std::vector<int> rows;
  std::vector<int> vertex;
  std::vector<signed char> slipping;
  for (int row = 0; row < interface.rows(); ++row) {
    if (!interface.faces(row)) continue;
    rows.push_back(row);
    vertex.push_back(fields.vertex[row]);
    slipping.push_back(fields.slipping[row]);
  }
  fields.vertex = std::move(vertex);
  fields.slipping = std::move(slipping);
  for (Vector* each : {&fields.gap, &fields.force, &fields.pressure}) *each = Vector((*each)(rows));
  for (Matrix* each : {&fields.friction, &fields.shear, &fields.slip})
    *each = Matrix((*each)(Eigen::all, rows));
}

/// What belongs to the rows of T, by nodes: along the line, in space along the axes.
Matrix byNodes(const ContactInterface& interface, const Vector& values) {
  if (interface.dimension() == 2) return values.transpose();
  Matrix vectors(3, interface.rows());
  for (int i = 0; i < interface.rows(); ++i) {
    const auto& [t1, t2] = interface.tangents()[i];
    vectors.col(i) = values[2 * i] * t1 + values[2 * i + 1] * t2;
  }
  return vectors;
}

}  // namespace

ContactFields contactFields(const Model& model, const State& state, size_t interface) {
  const ContactInterface& of = model.interfaces[interface];
  const ContactPair& pair = of.pair();
  Vector gap = of.gap(state.bodies[pair.nonmortar.body].displacement,
                      state.bodies[pair.mortar.body].displacement, state.time);
  const Vector& force = state.contactForce[interface];
  if (of.yields()) gap -= of.yielded(force);
  const Matrix none = Matrix::Zero(of.dimension() == 2 ? 1 : 3, of.rows());
  ContactFields fields{of.nonmortarNodes(),
                       {},
                       (0 - gap.array()).matrix(),
                       force,
                       of.contactPressure(force),
                       none,
                       none,
                       none,
                       std::vector<signed char>(of.rows(), 0)};
  if (of.hasFriction()) {
    fields.friction = byNodes(of, state.frictionForce[interface]);
    for (Eigen::Index c = 0; c < none.rows(); ++c)
      fields.shear.row(c) = of.contactPressure(fields.friction.row(c)).transpose();
    fields.slip = byNodes(of, of.slip(state.bodies[pair.nonmortar.body].displacement,
                                      state.bodies[pair.mortar.body].displacement));
    fields.slipping = state.slipping[interface];
  }
  if (of.follows()) keepFacing(of, fields);
  const Body& nonmortar = model.bodies[pair.nonmortar.body];
  for (const int vertex : fields.vertex) fields.place.push_back(nonmortar.placeOfNode(vertex));
  return fields;
}

void writeHistoryHeader(OutputFile& file, const std::vector<std::string>& columns) {
  writeLine(file, columns, [&](const std::string& name) { file << name; });
}

void writeHistoryRow(OutputFile& file, const StepReport& report) {
  writeLine(file, historyRow(report),
            [&](const HistoryValue& value) { std::visit([&](const auto& each) { file << each; }, value); });
}

void writeContactHeader(OutputFile& file, const Model& model) {
  file << "step,time,interface,vertex,x,y," << (model.bodies.front().dimension() == 3 ? "z," : "")
       << "gap,force,pressure,active";
  if (anyFriction(model) && model.bodies.front().dimension() == 3)
    file << ",friction_x,friction_y,friction_z,shear_x,shear_y,shear_z,slip_x,slip_y,slip_z,slipping";
  else if (anyFriction(model))
    file << ",friction,shear,slip,slipping";
  file << '\n';
}

void writeContactRows(OutputFile& file, const Model& model, const State& state, int step) {
  const bool friction = anyFriction(model);
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactFields fields = contactFields(model, state, k);
    for (size_t i = 0; i < fields.vertex.size(); ++i) {
      file << step << ',' << state.time << ',' << k << ',' << fields.vertex[i];
      for (int c = 0; c < model.bodies.front().dimension(); ++c) file << ',' << fields.place[i][c];
      file << ',' << fields.gap[i] << ',' << fields.force[i] << ',' << fields.pressure[i] << ','
           << (fields.force[i] > 0 ? 1 : 0);
      for (const Matrix* each : {&fields.friction, &fields.shear, &fields.slip})
        for (Eigen::Index c = 0; friction && c < each->rows(); ++c)
          file << ',' << (*each)(c, static_cast<Eigen::Index>(i));
      if (friction) file << ',' << static_cast<int>(fields.slipping[i]);
      file << '\n';
    }
  }
}

}  // namespace mortier
