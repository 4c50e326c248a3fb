// The words by which a scene chooses, each list in the order of the enumeration it stands for.
#pragma once

#include <iterator>

#include "material/perzyna.h"
#include "scene/schema.h"

namespace mortier {

inline const Keys planeWords{"stress", "strain", "axisymmetric"};        // Plane
inline const Keys couplingWords{"interpolation", "mortar", "weighted"};  // CouplingKind
inline const Keys initialWords{"as-meshed", "close", "reject"};          // InitialGap
inline const Keys slidingWords{"refuse", "allow"};                       // whether past the end
inline const Keys projectionWords(std::begin(projectionNames), std::end(projectionNames));  // Projection
inline const Keys schemeWords{"backward-euler", "crank-nicolson", "sdirk2"};                // Scheme
inline const Keys methodWords{"newton", "penalty-duality"};                                 // Method
inline const Keys linearWords{"multifrontal", "suitesparse"};                               // LinearEngine
inline const Keys quantityKeys{"reaction",                                                  // Quantity::Kind
                               "contact_force",  "displacement",  "stored_energy", "dissipated_energy",
                               "work",           "external_work", "thermal_work",  "largest_pressure",
                               "contact_length", "largest_mises", "friction_work", "mean_pressure"};
inline const Keys componentWords{"x", "y", "moment"};  // Quantity::Component

}  // namespace mortier
