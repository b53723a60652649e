// The orders in which lists leave the pipeline, whatever order they were found in.
#pragma once

#include <vector>

#include "bullet_plugin/core/threads/thread_team.h"
#include "kernels/shared/contact.h"
#include "kernels/shared/mesh.h"

namespace drape
{
// Sorts by cloth triangle, then by obstacle triangle.
void sortCandidates(std::vector<Candidate>& candidates);

// Sorts by cloth feature index (slot), then by obstacle feature.
void sortContacts(std::vector<Contact>& contacts);
// Puts hits behind the contacts that there are, in the same order. Those of each slot have been counted, and the counts
// are used up.
void orderHits(const Contact* hits, std::size_t count, std::vector<std::uint32_t>& slotCount,
               std::vector<Contact>& contacts, ThreadTeam& threads);
}  // namespace drape
