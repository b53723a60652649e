#include "tests/support/pipeline_driver.h"

#include <algorithm>

#include "scenes/describe_mesh.h"

namespace drape::test
{
MeshId addCloth(Pipeline& pipeline, const TriangleMesh& mesh)
{
    return pipeline.addCloth(describeMesh(mesh));
}
MeshId addObstacle(Pipeline& pipeline, const TriangleMesh& mesh)
{
    return pipeline.addObstacle(describeMesh(mesh));
}

void setMotion(Pipeline& pipeline, MeshId cloth, const std::vector<float>& start, const std::vector<float>& end)
{
    std::copy(start.begin(), start.end(), pipeline.clothStart(cloth));
    std::copy(end.begin(), end.end(), pipeline.clothEnd(cloth));
}

std::vector<Contact> runStep(Pipeline& pipeline)
{
    pipeline.submit();
    const ContactList contacts = pipeline.finish();
    return {contacts.begin(), contacts.end()};
}

std::vector<Contact> runCase(Pipeline& pipeline, const StepCase& step)
{
    const MeshId cloth = addCloth(pipeline, step.m_cloth), obstacle = addObstacle(pipeline, step.m_obstacle);
    setMotion(pipeline, cloth, step.m_cloth.m_positions, step.m_end);
    pipeline.addPair(cloth, obstacle, step.m_thickness);
    return runStep(pipeline);
}
}  // namespace drape::test
