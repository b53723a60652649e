#include "bullet_plugin/adapter/collision/held_group.h"

#include <algorithm>
#include <utility>

#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/core/solver/host/common_motion.h"

namespace drape
{
namespace
{
bool isValid(const btVector3& start, const btSoftBody::Node& node)
{
    return positionIsValid(vec3Of(start)) && positionIsValid(vec3Of(node.m_v));
}

Inertia inertiaOf(const btRigidBody& body)
{
    const btMatrix3x3 tensor = body.getInvInertiaTensorWorld().inverse();
    return {double(tensor[0][0]), double(tensor[1][1]), double(tensor[2][2]),
            double(tensor[1][2]), double(tensor[2][0]), double(tensor[0][1])};
}
}  // namespace

void HeldGroup::add(btSoftBody& body, StartOf startOf)
{
    const auto isThere = [&](const Cloth& cloth) { return cloth.m_body == &body; };
    if (std::none_of(m_cloths.begin(), m_cloths.end(), isThere)) m_cloths.push_back({&body, std::move(startOf)});
}

void HeldGroup::add(btRigidBody& body, const btTransform& start)
{
    const auto isThere = [&](const Rigid& rigid) { return rigid.m_body == &body; };
    if (std::any_of(m_rigid.begin(), m_rigid.end(), isThere)) return;
    m_rigid.push_back({&body, start});
    const btVector3 free(1, 1, 1), &inverse = body.getInvInertiaDiagLocal();
    m_rests = m_rests || body.getLinearFactor() != free;
    m_turns = m_turns && body.getAngularFactor() == free && inverse.x() > 0 && inverse.y() > 0 && inverse.z() > 0;
}

bool HeldGroup::hasHeldNode() const
{
    for (const Cloth& cloth : m_cloths)
        for (int i = 0; i < cloth.m_body->m_nodes.size(); ++i)
            if (!(movableInverseMass(cloth.m_body->m_nodes[i]) > 0)) return true;
    return false;
}

void HeldGroup::hold() const
{
    CommonMotion motion;
    if (!m_rests && !hasHeldNode())
    {
        for (const Cloth& cloth : m_cloths)
            for (int i = 0; i < cloth.m_body->m_nodes.size(); ++i)
            {
                const btSoftBody::Node& node = cloth.m_body->m_nodes[i];
                const btVector3 start = cloth.m_startOf(std::size_t(i));
                if (isValid(start, node)) motion.add(1 / double(node.m_im), wideOf(start), wideOf(node.m_v));
            }
        for (const Rigid& rigid : m_rigid)
            motion.addBody(1 / double(rigid.m_body->getInvMass()), wideOf(rigid.m_start.getOrigin()),
                           wideOf(rigid.m_body->getLinearVelocity()), m_turns ? inertiaOf(*rigid.m_body) : Inertia(),
                           wideOf(rigid.m_body->getAngularVelocity()));
        motion.compute(m_turns);
    }
    for (const Cloth& cloth : m_cloths)
        for (int i = 0; i < cloth.m_body->m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = cloth.m_body->m_nodes[i];
            const btVector3 start = cloth.m_startOf(std::size_t(i));
            if (!(node.m_im > 0) || !isValid(start, node)) continue;
            node.m_x = start;
            node.m_v = narrowOf(motion.velocityAt(wideOf(node.m_x)));
        }
    for (const Rigid& rigid : m_rigid)
    {
        rigid.m_body->setLinearVelocity(narrowOf(motion.velocityAt(wideOf(rigid.m_start.getOrigin()))));
        rigid.m_body->setAngularVelocity(narrowOf(motion.spin()));
        rigid.m_body->setCenterOfMassTransform(rigid.m_start);
    }
}
}  // namespace drape
