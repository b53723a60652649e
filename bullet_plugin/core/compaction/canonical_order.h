// The orders in which lists leave the pipeline, whatever order they were found in.
#pragma once

#include <vector>

#include "kernels/shared/contact.h"
#include "kernels/shared/mesh.h"

namespace drape
{
// By cloth triangle, then obstacle triangle.
void sortCandidates(std::vector<Candidate>& candidates);

// By slot, then obstacle feature.
void sortContacts(std::vector<Contact>& contacts);
}  // namespace drape
