// Parts of the time of a whole stepSimulation with Drape. Times are in ms.
#pragma once

#include <drape/report.h>

#include <array>

namespace drape
{
struct WholeStepParts : StepParts
{
    double m_dispatchMs = 0;  // Bullet's collision detection, and Drape's part in it
    double m_rigidMs = 0;     // the rest of Bullet's step outside of the solver's calls
};

// Returns the parts of a step of stepMs, of which Bullet's collision detection took dispatchMs and the solver's calls
// callsMs.
inline WholeStepParts partsOf(const StepParts& parts, double stepMs, double dispatchMs, double callsMs)
{
    WholeStepParts whole;
    static_cast<StepParts&>(whole) = parts;
    whole.m_dispatchMs = dispatchMs;
    whole.m_rigidMs = stepMs - dispatchMs - callsMs;
    return whole;
}

struct NamedPart
{
    const char* m_name;
    double WholeStepParts::*m_ms;
};

// Lists the parts that do not overlap, in the order of the step.
inline const std::array<NamedPart, 13>& stepParts()
{
    static const std::array<NamedPart, 13> parts = {{{"rigid", &WholeStepParts::m_rigidMs},
                                                     {"dispatch", &WholeStepParts::m_dispatchMs},
                                                     {"mirror", &WholeStepParts::m_mirrorMs},
                                                     {"predict", &WholeStepParts::m_predictMs},
                                                     {"read", &WholeStepParts::m_readMs},
                                                     {"upload", &WholeStepParts::m_uploadMs},
                                                     {"wait", &WholeStepParts::m_waitMs},
                                                     {"sort", &WholeStepParts::m_writeMs},
                                                     {"solve", &WholeStepParts::m_solveMs},
                                                     {"bullet_links", &WholeStepParts::m_bulletMs},
                                                     {"write_back", &WholeStepParts::m_writeBackMs},
                                                     {"check", &WholeStepParts::m_checkMs},
                                                     {"normals", &WholeStepParts::m_normalsMs}}};
    return parts;
}
}  // namespace drape
