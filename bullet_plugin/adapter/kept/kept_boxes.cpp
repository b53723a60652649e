#include "bullet_plugin/adapter/kept/kept_boxes.h"

#include <algorithm>
#include <cmath>

#include "bullet_plugin/adapter/vectors.h"

namespace drape
{
namespace
{
void add(KeptBoxes& boxes, int box, const btVector3& v)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const float number = float(v[axis]);
        boxes.m_low[box][axis] = std::min(boxes.m_low[box][axis], number);
        boxes.m_high[box][axis] = std::max(boxes.m_high[box][axis], number);
        boxes.m_areFinite = boxes.m_areFinite && std::isfinite(number);
    }
}
}  // namespace

KeptBoxes boxesAround(const btSoftBody& body, const KeptStep& step, const std::vector<KeptNode>& nodes)
{
    KeptBoxes boxes;
    std::fill_n(&boxes.m_low[0][0], 3 * DRAPE_KEPT_BOXES, HUGE_VALF);
    std::fill_n(&boxes.m_high[0][0], 3 * DRAPE_KEPT_BOXES, -HUGE_VALF);
    boxes.m_areFinite = true;
    const btVector3 gravity = vectorOf(step.m_gravity);
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[i];
        const btVector3 velocity = node.m_im > 0 ? node.m_v + gravity : node.m_v;
        const btVector3 free = node.m_x + velocity * step.m_time;
        add(boxes, 0, node.m_x);
        add(boxes, 1, free);
        const btVector3 support = vectorOf(nodes[static_cast<std::size_t>(i)].m_support);
        add(boxes, 2, free + ((velocity - node.m_v) * step.m_perSecond * step.m_shift + support * step.m_supportShift));
    }
    return boxes;
}
}  // namespace drape
