// Sorts lists into the order in which they leave the pipeline, whatever the order of the search.
#pragma once

#include <vector>

#include "bullet_plugin/core/threads/thread_team.h"
#include "kernels/shared/contact.h"
#include "kernels/shared/mesh.h"

namespace drape
{
// Sorts by cloth triangle, then by obstacle triangle.
void sortCandidates(std::vector<Candidate>& candidates);

// Sorts by cloth feature index, then by obstacle feature.
void sortContacts(std::vector<Contact>& contacts);
// Appends unsorted contacts to the existing ones, in the same order. featureCounts: contacts of each feature; used
// as working memory.
void orderContacts(const Contact* unsorted, std::size_t count, std::vector<std::uint32_t>& featureCounts,
                   std::vector<Contact>& contacts, ThreadTeam& threads);
}  // namespace drape
