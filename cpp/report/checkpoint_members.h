// What of a run a checkpoint holds, for archives: every member by name, so that one that is added and
// forgotten here does not compile.
#pragma once

#include "report/checkpoint.h"

namespace mortier {

template <class Archive>
void visitMembers(Archive& archive, RunIdentity& identity) {
  auto& [workingFolder, scene, text, settings, meshes, meshHashes] = identity;
  archive(workingFolder, scene, text, settings, meshes, meshHashes);
}
template <class Archive>
void visitMembers(Archive& archive, FileRecord& file) {
  auto& [bytes, checksum] = file;
  archive(bytes, checksum);
}
template <class Archive>
void visitMembers(Archive& archive, KeptFields& fields) {
  auto& [step, time, files] = fields;
  archive(step, time, files);
}
template <class Archive>
void visitMembers(Archive& archive, FilesSoFar& files) {
  auto& [history, contact, fields] = files;
  archive(history, contact, fields);
}
template <class Archive>
void visitMembers(Archive& archive, Certificate& certificate) {
  auto& [forceBalance, materialResidual, gapOnActive, openPenetration, sign, complementarity, rounding] =
      certificate;
  archive(forceBalance, materialResidual, gapOnActive, openPenetration, sign, complementarity, rounding);
}
template <class Archive>
void visitMembers(Archive& archive, SpecialConditions& special) {
  auto& [idle, dependent] = special;
  archive(idle, dependent);
}
template <class Archive>
void visitMembers(Archive& archive, StepReport& report) {
  auto& [step, time, timeStep, status, reason, rung, guarded, rejections, estimate, iterations,
         factorisations, active, joined, left, penetration, maxPressure, contactForce, resultantX, resultantY,
         vonMises, displacement, motion, energy, viscoplasticFraction, certificate] = report;
  archive(step, time, timeStep, status, reason, rung, guarded, rejections, estimate, iterations,
          factorisations, active, joined, left, penetration, maxPressure, contactForce, resultantX,
          resultantY, vonMises, displacement, motion, energy, viscoplasticFraction, certificate);
}
template <class Archive>
void visitMembers(Archive& archive, Peak& peak) {
  auto& [value, time] = peak;
  archive(value, time);
}
template <class Archive>
void visitMembers(Archive& archive, Peaks& peaks) {
  auto& [vonMises, pressure, contactForce, displacement, motion, energy] = peaks;
  archive(vonMises, pressure, contactForce, displacement, motion, energy);
}
template <class Archive>
void visitMembers(Archive& archive, AccuracyMemory& accuracy) {
  auto& [energy, error, time] = accuracy;
  archive(energy, error, time);
}
template <class Archive>
void visitMembers(Archive& archive, RunReport& report) {
  auto& [status, reason, steps, iterations, maxIterationsInAStep, factorisations, pilotIterations, rejected,
         timeError, guarded, solveSeconds, special, worst, peaks, rungs] = report;
  archive(status, reason, steps, iterations, maxIterationsInAStep, factorisations, pilotIterations, rejected,
          timeError, guarded, solveSeconds, special, worst, peaks, rungs);
}
template <class Archive>
void visitMembers(Archive& archive, BodyState& body) {
  auto& [displacement, stress, viscoplasticStrain] = body;
  archive(displacement, stress, viscoplasticStrain);
}
template <class Archive>
void visitMembers(Archive& archive, State& state) {
  auto& [time, bodies, contactForce, gap] = state;
  archive(time, bodies, contactForce, gap);
}
template <class Archive>
void visitMembers(Archive& archive, BodyIncrement& increment) {
  auto& [displacement, stress] = increment;
  archive(displacement.high, displacement.low, stress);
}
template <class Archive>
void visitMembers(Archive& archive, ErrorNorms& norms) {
  auto& [stress, displacement] = norms;
  archive(stress, displacement);
}
template <class Archive>
void visitMembers(Archive& archive, ControllerMemory& controller) {
  auto& [trial, start, timeStep, scale, largest, local, strain, error, worst] = controller;
  archive(trial, start, timeStep, scale, largest, local, strain, error, worst);
}
template <class Archive>
void visitMembers(Archive& archive, SolverMemory& solver) {
  auto& [libraries, elasticFactors] = solver;
  archive(libraries, elasticFactors);
}
template <class Archive>
void visitMembers(Archive& archive, MarchMemory& memory) {
  auto& [begin, run, increments, timeStep, solver, controller] = memory;
  archive(begin, run, increments, timeStep, solver, controller);
}
template <class Archive>
void visitMembers(Archive& archive, Checkpoint& checkpoint) {
  auto& [identity, empty, files, last, state, memory, accuracy] = checkpoint;
  archive(identity, empty, files, last, state, memory, accuracy);
}

}  // namespace mortier
