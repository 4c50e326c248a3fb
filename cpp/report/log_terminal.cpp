#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "report/clock.h"
#include "report/log.h"

namespace mortier {

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
