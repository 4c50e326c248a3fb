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
                   model.bodies.front().space() != nullptr ? "tetrahedra" : "triangles");
}

std::string logRound(const std::vector<RoundFacts>& rounds) {
  const RoundFacts& last = rounds.back();
  const std::string mesh = std::isfinite(last.mesh) ? formatted("%8.3g %%", 100 * last.mesh) : "   unknown";
  return formatted("%6zu  %9zu  %8d  %5d  %s  %8.2g %%  %7.3g\n", rounds.size(), last.elements, last.unknowns,
                   last.steps, mesh.c_str(), 100 * last.time, last.seconds);
}

std::string logRow(const StepReport& r) {
  std::string remarks = r.rung == Rung::newton ? "" : std::string("  ") + nameOf(r.rung);
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

std::string logDeformation(const Peaks& peaks, const Units& units, const Peaks& before) {
  std::string text;
  const auto passes = [](const Peak& peak, const Peak& earlier, double most) {
    return peak.value > most && !(earlier.value > most);
  };
  if (passes(peaks.strain, before.strain, smallStrain))
    text += formatted("warning    strains reach %.2g %% at t = %.5g %s; they are taken as small here\n",
                      100 * peaks.strain.value, peaks.strain.time, units.time.c_str());
  if (passes(peaks.rotation, before.rotation, smallRotation))
    text += formatted(
        "warning    bodies turn by up to %.2g degrees at t = %.5g %s; rotations are taken as small here\n",
        peaks.rotation.value * 180 / M_PI, peaks.rotation.time, units.time.c_str());
  return text;
}

std::string logTrial(double error, double tolerance) {
  return formatted(
      "           error in time %.2g, tolerance %.2g: begun again with smaller errors of a step\n", error,
      tolerance);
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
