// A progress bar on standard error, where that is a terminal and the run takes longer than two seconds.
#pragma once

namespace mortier {

class Progress {
 public:
  Progress(bool wanted, double endTime);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  /// Draws the bar for a run that has reached `time` [s of the model].
  void show(double time);
  /// Removes it, so that a line can be printed.
  void clear();

 private:
  bool enabled_;
  bool drawn_ = false;
  double endTime_;
  double start_;
  double lastDrawn_ = 0;
};

}  // namespace mortier
