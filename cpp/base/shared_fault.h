// Data that are wrong where one rank alone sees it.
#pragma once

#include <string>

#include "base/datum_error.h"
#include "base/ranks.h"

namespace mortier {

/// Calls work(). A DatumError of any rank is thrown by all. Collective.
template <class Work>
void withSharedFaults(Ranks& ranks, const Work& work) {
  std::string fault;
  try {
    work();
    return;
  } catch (const DatumError& error) {
    fault = error.what();
    ranks.tellFault();
  } catch (const PeerFault&) {
  }
  throw DatumError(textOfAny(ranks, fault));
}

}  // namespace mortier
