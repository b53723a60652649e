#include "impact_cut.h"

#include <algorithm>

namespace drape
{
namespace
{
// Distance before the surface at which a path ends, as a share of the thickness. It is near enough for every contact
// there and far enough from the other side.
constexpr float kStandOff = 0.5f;

// Returns the share of the path to keep: 1 when nothing was met or the cloth's point moves away.
float shareLeft(const SolverContact& contact)
{
    if (!(contact.m_time < 1) || contact.m_gaps.m_end >= contact.m_gaps.m_start) return 1;
    const float distance = contact.m_gaps.m_start + contact.m_thickness;  // at the step's start
    const float standOff = kStandOff * contact.m_thickness;
    return distance > standOff ? contact.m_time * (1 - standOff / distance) : 0.0f;
}

// The kept share of a node's path, relative to the obstacle of its first impact, with the normal of the surface there
// and the coefficient of friction.
struct Left
{
    float m_share = 1;
    Carry m_carry;
    Vec3 m_normal = {};
    float m_friction = 0;
    std::size_t m_contact = 0;  // index

    void take(const Left& other)
    {
        if (other.m_share < m_share) *this = other;
    }
};

// Returns the velocity that the node loses, m/s.
Vec3 shorten(SolverNodes& nodes, std::size_t node, const Left& left, float perSecond)
{
    const Vec3 start = nodes.start(node);
    const Vec3 carried = vec3Sub(left.m_carry.start(node, start), start);
    const Vec3 shift = vec3Scale(vec3Sub(nodes.displacement(node), carried), left.m_share - 1);
    nodes.shift(node, shift);
    nodes.addVelocity(node, vec3Scale(shift, perSecond));
    return vec3Scale(shift, -perSecond);
}

// Returns what a surface leaves of a velocity: that along it, less friction, or all of one that leads away.
Vec3 slideOf(Vec3 velocity, Vec3 normal, float friction)
{
    const float towards = -vec3Dot(velocity, normal);
    if (!(towards > 0)) return velocity;
    const Vec3 along = vec3AddScaled(velocity, normal, towards);
    const float speed = vec3Length(along);
    return vec3Scale(along, speed > 0 ? std::max(0.0f, 1 - friction * towards / speed) : 0.0f);
}
}  // namespace

bool anyCuts(const std::vector<SolverContact>& contacts)
{
    return std::any_of(contacts.begin(), contacts.end(),
                       [](const SolverContact& contact) { return shareLeft(contact) < 1; });
}

bool cutAtImpacts(SolverNodes& nodes, const std::vector<SolverContact>& contacts, Cut cut, float perSecond,
                  std::vector<Vec3>* slides, std::vector<Vec3>* impulses)
{
    if (impulses) impulses->assign(contacts.size(), vec3(0, 0, 0));
    if (contacts.empty()) return false;
    std::vector<Left> left(nodes.count());
    Left least;
    for (std::size_t i = 0; i < contacts.size(); ++i)
    {
        const SolverContact& contact = contacts[i];
        const Left own{shareLeft(contact), contact.m_carry, contact.m_plane.m_normal, contact.m_friction, i};
        least.take(own);
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            left[std::size_t(contact.m_nodes[k])].take(own);
    }
    if (!(least.m_share < 1)) return false;
    if (slides) slides->resize(nodes.count(), vec3(0, 0, 0));
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const Left& own = cut == Cut::WholeBody ? least : left[i];
        if (!(own.m_share < 1) || !(nodes.inverseMass(i) > 0)) continue;
        const Vec3 lost = shorten(nodes, i, own, perSecond);
        Vec3 gained = vec3Scale(lost, -1);
        if (slides && own.m_share > 0)
        {
            const Vec3 before = (*slides)[i];
            (*slides)[i] = slideOf(vec3Add(before, lost), own.m_normal, own.m_friction);
            gained = vec3Add(gained, vec3Sub((*slides)[i], before));
        }
        if (impulses)
            (*impulses)[own.m_contact] = vec3AddScaled((*impulses)[own.m_contact], gained, 1 / nodes.inverseMass(i));
    }
    return true;
}
}  // namespace drape
