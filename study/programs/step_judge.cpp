#include "study/programs/step_judge.h"

#include <iostream>

namespace drape::bench
{
bool agree(const std::string& name, const std::vector<StepOutcome>& run, const std::vector<StepOutcome>& reference,
           bool bothListTriangles)
{
    for (std::size_t step = 0; step < reference.size(); ++step)
    {
        const bool contacts = step < run.size() && run[step].m_hash == reference[step].m_hash;
        const bool candidates =
            !bothListTriangles || (step < run.size() && run[step].m_candidates == reference[step].m_candidates);
        if (contacts && candidates) continue;
        std::cerr << "study: " << name << ": step " << step << " has other " << (contacts ? "candidates" : "contacts")
                  << std::endl;
        return false;
    }
    return true;
}

void judgeStep(Row& row, const StepOutcome& reference, bool agrees)
{
    judgeRow(row, agrees ? reference.m_hash : "that of a run without a wrong step");
}
}  // namespace drape::bench
