#include "report/result_files.h"

#include <filesystem>

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

ResultFiles::ResultFiles(const std::string& folder, const Model& model, CurrentSpaceError& error,
                         const std::vector<Quantity>& quantities, const Units& units)
    : model_(model),
      history_(folder + "/history.csv"),
      contact_(folder + "/contact.csv"),
      fields_(folder, model, error),
      lastKept_(-1) {
  writeHistoryHeader(history_, historyColumns(model, quantities, units));
  writeContactHeader(contact_, model);
}

ResultFiles::ResultFiles(const std::string& folder, const Model& model, CurrentSpaceError& error,
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

}  // namespace mortier
