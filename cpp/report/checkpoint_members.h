// What of a run a checkpoint holds, for archives: every member by name, so that one that is added and
// forgotten here does not compile.
#pragma once

#include "report/checkpoint.h"
#include "report/stored_state.h"

namespace mortier {

#define MORTIER_MEMBERS(Type, ...)                   \
  template <class Archive>                           \
  void visitMembers(Archive& archive, Type& whole) { \
    auto& [__VA_ARGS__] = whole;                     \
    archive(__VA_ARGS__);                            \
  }

MORTIER_MEMBERS(RunIdentity, workingFolder, scene, text, settings, files, fileHashes)
MORTIER_MEMBERS(FileRecord, bytes, checksum)
MORTIER_MEMBERS(KeptFields, step, time, files)
MORTIER_MEMBERS(FilesSoFar, history, contact, fields)
MORTIER_MEMBERS(Certificate, forceBalance, materialResidual, gapOnActive, openPenetration, sign,
                complementarity, friction, rounding)
MORTIER_MEMBERS(SpecialConditions, idle, dependent)
MORTIER_MEMBERS(ListedSolution, index, residual, contact, friction, sets)
MORTIER_MEMBERS(StepSolutions, ambiguous, listed)
MORTIER_MEMBERS(SeveralSolutions, step, time, listed)
MORTIER_MEMBERS(StepReport, step, time, timeStep, status, reason, method, guarded, rejections, estimate,
                iterations, factorisations, active, joined, left, penetration, maxPressure, contactForce,
                resultantX, resultantY, resultantZ, vonMises, displacement, motion, energy,
                viscoplasticFraction, certificate, quantities, frictionWork, solutions)
MORTIER_MEMBERS(Peak, value, time)
MORTIER_MEMBERS(QuantityRange, start, smallest, smallestTime, largest, largestTime)
MORTIER_MEMBERS(Peaks, vonMises, pressure, contactForce, displacement, motion, energy, sliding, strain,
                rotation)
MORTIER_MEMBERS(BodyOverlap, area, depth, place, drawn, time, bodies, labels, explained, shallow, words)
MORTIER_MEMBERS(AccuracyMemory, energy, error, time)
MORTIER_MEMBERS(WorkDone, external, contact, dissipated, thermal)
MORTIER_MEMBERS(BodyState, displacement, stress, viscoplasticStrain, work, thermalStrain)
MORTIER_MEMBERS(State, time, bodies, contactForce, gap, frictionForce, slipping, frictionWork, frictionWorkOf,
                gapWork, tieForce)
MORTIER_MEMBERS(StoredState::StoredBody, name, mesh, laws)
MORTIER_MEMBERS(StoredState::StoredPair, bodies, labels, nodes)
MORTIER_MEMBERS(StoredState, kind, bodies, contacts, ties, state)
MORTIER_MEMBERS(TwoPartVector, high, low)
MORTIER_MEMBERS(BodyIncrement, displacement, stress)
MORTIER_MEMBERS(ErrorNorms, stress, displacement, friction)
MORTIER_MEMBERS(SlipAndWork, slip, work, strain)
MORTIER_MEMBERS(ControllerMemory, trial, shortestInaccurate, crossing, start, timeStep, scale, largest, local,
                strain, error, worst, slip, missed, pairEnd)
MORTIER_MEMBERS(SolverMemory, enginesGivenUp, elasticFactors)
MORTIER_MEMBERS(MarchMemory, begin, run, increments, timeStep, solver, controller)
MORTIER_MEMBERS(Checkpoint, identity, empty, files, last, state, memory, accuracy)

#undef MORTIER_MEMBERS

/// A run of which there is a checkpoint is not stuck.
template <class Archive>
void visitMembers(Archive& archive, RunReport& whole) {
  auto& [status, reason, shortfall, stuck, steps, iterations, maxIterationsInAStep, factorisations,
         pilotIterations, rejected, timeError, guarded, solveSeconds, special, worst, peaks, quantities,
         rungs, ambiguousSteps, several, overlap] = whole;
  static_cast<void>(stuck);
  archive(status, reason, shortfall, steps, iterations, maxIterationsInAStep, factorisations, pilotIterations,
          rejected, timeError, guarded, solveSeconds, special, worst, peaks, quantities, rungs,
          ambiguousSteps, several, overlap);
}

}  // namespace mortier
