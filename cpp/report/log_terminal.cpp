#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/formatted.h"
#include "report/clock.h"
#include "report/log.h"

namespace mortier {

std::string logStepsHeader(const Units& units) {
  return formatted("%6s  %10s  %4s  %13s  %10s  %16s  %10s  %12s  %10s\n", "step",
                   ("time[" + units.time + "]").c_str(), "iter", "active(+/-)", "|residual|",
                   ("penetration[" + units.penetration() + "]").c_str(),
                   ("max p[" + units.stress + "]").c_str(), "viscoplastic",
                   ("force[" + units.forcePerDepth() + "]").c_str());
}

std::string logRoundsHeader(const Model& model) {
  return formatted(" round %10s  unknowns  steps  mesh error  time error  seconds\n",
                   model.bodies.front().elementsWord());
}

std::string logRound(const std::vector<RoundFacts>& rounds) {
  const RoundFacts& last = rounds.back();
  const std::string mesh = std::isfinite(last.mesh) ? formatted("%8.3g %%", 100 * last.mesh) : "   unknown";
  return formatted("%6zu  %9zu  %8d  %5d  %s  %8.2g %%  %7.3g\n", rounds.size(), last.elements, last.unknowns,
                   last.steps, mesh.c_str(), 100 * last.time, last.seconds);
}

std::string logRow(const StepReport& r) {
  std::string remarks = r.method == SolutionMethod::newton ? "" : std::string("  ") + nameOf(r.method);
  if (r.guarded) remarks += "  guarded";
  if (r.rejections > 0) remarks += "  " + std::to_string(r.rejections) + " rejected";
  if (const size_t found = r.solutions.listed.size(); found > 1)
    remarks += "  one of " + std::to_string(found) + " solutions";
  else if (r.solutions.ambiguous)
    remarks += "  several solutions possible";
  const std::string change = formatted("%d (+%d/-%d)", r.active, r.joined, r.left);
  return formatted("%6d  %10.5g  %4d  %13s  %10.1e  %16.1e  %10.5g  %11.0f%%  %10.5g%s\n", r.step, r.time,
                   r.iterations, change.c_str(),
                   std::max(r.certificate.forceBalance, r.certificate.materialResidual), r.penetration,
                   r.maxPressure, 100 * r.viscoplasticFraction, r.contactForce, remarks.c_str());
}

std::vector<std::string> deformationWarnings(const Peaks& peaks, const Units& units, const Peaks& before) {
  std::vector<std::string> warnings;
  const auto passes = [](const Peak& peak, const Peak& earlier, double most) {
    return peak.value > most && !(earlier.value > most);
  };
  if (passes(peaks.strain, before.strain, smallStrain))
    warnings.push_back(formatted("strains reach %.2g %% at t = %.5g %s; they are taken as small here",
                                 100 * peaks.strain.value, peaks.strain.time, units.time.c_str()));
  if (passes(peaks.rotation, before.rotation, smallRotation))
    warnings.push_back(
        formatted("bodies turn by up to %.2g degrees at t = %.5g %s; rotations are taken as small here",
                  peaks.rotation.value * 180 / M_PI, peaks.rotation.time, units.time.c_str()));
  return warnings;
}

std::vector<std::string> warningsOf(const RunReport& report, const Model& model, const Units& units) {
  constexpr double noticeable = 0.5;
  const Peaks& peaks = report.peaks;
  const BodyOverlap& overlap = report.overlap;
  const bool touched = peaks.contactForce.value > 0;
  std::vector<std::string> warnings;
  if (overlap.shallow)
    warnings.push_back(overlap.words + ": the meshes do not resolve it");
  else if (overlap.depth > 0 && overlap.explained && !touched)
    warnings.push_back("no contact presses, and " + overlap.text(model.bodies.front().dimension()) +
                       " as drawn, or as a distance that is given or small sliding lets them");
  if (peaks.sliding.value > noticeable)
    warnings.push_back(formatted(
        "bodies slide along each other by up to %.3g edges at t = %.5g %s; slips are taken as small "
        "here",
        peaks.sliding.value, peaks.sliding.time, units.time.c_str()));
  for (std::string& warning : deformationWarnings(peaks, units)) warnings.push_back(std::move(warning));
  if (peaks.motion.value > 1 && peaks.strain.value == 0)
    warnings.push_back(
        formatted("displacements reach %.2g times the size of a body at t = %.5g %s; they are taken as small "
                  "here",
                  peaks.motion.value, peaks.motion.time, units.time.c_str()));
  if (!model.interfaces.empty() && !touched && overlap.depth == 0)
    warnings.emplace_back(
        "the bodies never touched: no contact pressed at any step (a motion too small to close the distance, "
        "the wrong direction, or meshes too coarse to see it)");
  return warnings;
}

std::string asLines(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += "warning    " + warning + "\n";
  return text;
}

std::string logTrial(double error, double tolerance) {
  return formatted("           error in time %.2g above tolerance %.2g: run restarted with smaller steps\n",
                   error, tolerance);
}

Log::Log(bool quiet, double endTime)
    : quiet_(quiet),
      sharesTerminal_(isatty(STDOUT_FILENO) == 1),
      hasBar_(!quiet && isatty(STDERR_FILENO) == 1),
      endTime_(endTime),
      start_(processSeconds()) {}

void Log::drawBar(double time) {
  constexpr double longRun = 2;     // [s]
  constexpr double interval = 0.1;  // [s]
  const double now = processSeconds();
  const double done = std::clamp(time / endTime_, 0.0, 1.0);
  if (!hasBar_ || done <= 0 || (now - start_) / done < longRun) return;
  // On the same terminal the log's row has just taken the bar away; elsewhere ten times a second are enough.
  if (drawn_ && now < lastDrawn_ + interval) return;
  constexpr int width = 40;
  const int filled = static_cast<int>(done * width);
  const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
  std::fflush(stdout);
  std::fprintf(stderr, "\r[%s] %3.0f %%, %.0f s left", bar.c_str(), 100 * done,
               (now - start_) * (1 - done) / done);
  std::fflush(stderr);
  drawn_ = true;
  lastDrawn_ = now;
}

void Log::finish() {
  if (drawn_) {
    std::fputs("\r\x1b[K", stderr);
    std::fflush(stderr);
    drawn_ = false;
  }
}

void Log::print(const std::string& text) {
  if (quiet_) return;
  if (sharesTerminal_) finish();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void Log::step(const StepReport& report) {
  constexpr double patience = 0.2;  // [s]: a fast run is not slowed by its log, a slow one is seen as it goes
  print(logRow(report));
  if (const double now = processSeconds(); !quiet_ && now > flushed_ + patience) {
    std::fflush(stdout);
    flushed_ = now;
  }
  drawBar(report.time);
}

}  // namespace mortier
