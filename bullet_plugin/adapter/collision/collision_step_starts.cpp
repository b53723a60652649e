// Handles the start of a step for pairs that are not guarded, and remembers its end for the next step's start.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>
#include <vector>

#include "bullet_plugin/adapter/collision/collision_step.h"
#include "bullet_plugin/adapter/collision/stretch.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"

namespace drape
{
namespace
{
bool isFinite(const btVector3& v)
{
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

// Limits movable nodes to kMostTangledSpeed relative to the body's median velocity. In a body that is left out and has
// fixed nodes the limit is relative to rest: nodes that are pulled after displaced pins do not shoot past them.
void limitSpeeds(btSoftBody& body, bool leftOut)
{
    std::vector<btVector3> velocities;
    bool held = false;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[i];
        if (!(movableInverseMass(node) > 0))
            held = true;
        else if (isFinite(node.m_v))
            velocities.push_back(node.m_v);
    }
    const btVector3 common = leftOut && held ? btVector3(0, 0, 0) : medianOf(std::move(velocities));
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        btSoftBody::Node& node = body.m_nodes[i];
        if (!(movableInverseMass(node) > 0)) continue;  // the app moves it
        const btScalar speed = (node.m_v - common).length();
        if (speed > kMostTangledSpeed) node.m_v = common + (node.m_v - common) * (kMostTangledSpeed / speed);
    }
}

std::size_t countInvalid(const btSoftBody& body)
{
    std::size_t count = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        count += !isFinite(body.m_nodes[i].m_q) || !isFinite(body.m_nodes[i].m_x);
    return count;
}
}  // namespace

// Lists the nodes that jumped. A body on the device has none, but is brought to the host if one of its pairs starts
// anew.
void CollisionStep::listJumped()
{
    for (const Pair& pair : m_pairs)
    {
        BodyContacts& body = *bodyOf(pair.m_cloth);
        if (body.m_isOnDevice && m_starts.startsAnew(pair.m_start)) bringToHost(body);
    }
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        m_jumped[i].clear();
        if (!m_bodies[i].m_isOnDevice) m_mirrors[i]->listJumped(m_state.threads(), m_jumped[i]);
    }
}

void CollisionStep::checkStarts()
{
    m_starts.beginStep();
    m_jumped.resize(std::max(m_jumped.size(), m_bodies.size()));
    listJumped();
    for (const Pair& pair : m_pairs)
    {
        const std::size_t body = m_byCloth.at(pair.m_cloth);
        const std::size_t pushes = m_bodies[body].m_pushes.size();
        m_starts.check(pair.m_start, m_jumped[body], m_bodies[body]);
        for (std::size_t i = pushes; i < m_bodies[body].m_pushes.size(); ++i)
            m_bodies[body].m_pushes[i].m_carry.m_starts = pair.m_carriedStarts;
    }
    for (BodyContacts& body : m_bodies)
    {
        preparePushes(body);
        body.m_contacts.m_isFiltered = !body.m_tangled.empty() || !body.m_pushes.empty() || body.m_hasDynamicPair;
    }
}

// Moves the predicted ends of nodes that are pushed, so that detection and the motion limit see where they go. Makes
// contacts of the pushes, so that links do not pull the nodes back.
void CollisionStep::preparePushes(BodyContacts& body)
{
    for (NodePush& push : body.m_pushes)
    {
        btSoftBody::Node& node = body.m_body->m_nodes[push.m_node];
        const btVector3 start = vectorOf(push.m_carry.start(std::size_t(push.m_node), vec3Of(node.m_q)));
        const btVector3 point = start + push.m_normal * push.m_distance;
        const btScalar endGap = push.m_normal.dot(node.m_x - point);
        SolverContact contact = {};
        contact.m_nodes[0] = push.m_node;
        contact.m_nodes[1] = contact.m_nodes[2] = -1;
        contact.m_plane.m_weights[0] = 1;
        contact.m_plane.m_normal = vec3Of(push.m_normal);
        contact.m_plane.m_point = vec3Of(point);
        contact.m_time = 1;
        contact.m_gaps.m_start = float(-push.m_distance);
        contact.m_gaps.m_end = float(endGap);
        contact.m_carry = push.m_carry;
        body.m_pushContacts.push_back(m_state.m_found.source().addOwn(contact));
        push.m_speedLimit = (std::max(btScalar(0), endGap + push.m_distance) + push.m_normal.dot(start - node.m_q)) *
                            body.m_body->m_sst.isdt;
        if (endGap < 0) node.m_x -= push.m_normal * endGap;
    }
}

// Adds contacts of one feature, without those that would keep it on the wrong side of their obstacle. Those with
// dynamic obstacles are listed apart until the bodies are solved.
void CollisionStep::addChosen(BodyContacts& body, const Contact* first, std::uint32_t count,
                              const OrderedFeature& ordered, Detection detection)
{
    const auto isHeld = [&](MeshId obstacle)
    {
        return std::all_of(body.m_tangled.begin(), body.m_tangled.end(),
                           [&](const TangledPair& tangled)
                           { return tangled.m_obstacle != obstacle || tangled.contains(ordered.m_nodes); });
    };
    const Contact* begin = first;  // first contact that is chosen and not added yet
    const Contact* const end = first + count;
    const auto add = [&](const Contact* last)
    {
        if (begin != last) addContacts(body, begin, static_cast<std::uint32_t>(last - begin), ordered);
        begin = last + 1;
    };
    for (const Contact* contact = first; contact != end; ++contact)
    {
        const MeshId obstacle = m_state.pipeline().view(*contact).m_obstacle;
        const DynamicBody* const dynamic = detection == Detection::Check ? nullptr : dynamicOf(obstacle);
        const bool held = isHeld(obstacle);
        if (held && dynamic) body.m_dynamicContacts.push_back({contact, *dynamic});
        if (!held || dynamic) add(contact);
    }
    add(end);
}

void CollisionStep::addPushes(BodyContacts& body)
{
    std::vector<FeatureContacts> pushes;
    for (std::size_t i = 0; i < body.m_pushes.size(); ++i)
    {
        const OrderedFeature& node = body.m_contacts.m_order->features()[std::size_t(body.m_pushes[i].m_node)];
        pushes.push_back(FeatureContacts{&body.m_pushContacts[i], 1, &node, 1});
        body.m_contacts.m_limit.addContactNode(body.m_pushes[i].m_node);
    }
    std::vector<FeatureContacts>& features = body.m_contacts.m_features;
    features.insert(features.begin(), pushes.begin(), pushes.end());  // nodes are first
}

// Handles a body that needs too many tests. A body that has changed its size is held together and detected again. If
// that is not enough, the body is left out of the step. The log has one line while that lasts.
void CollisionStep::leaveOut(std::size_t index)
{
    BodyContacts& body = m_bodies[index];
    const ClothFaces& faces = m_mirrors[index]->faces();
    const Stretch stretch = stretchOf(*body.m_body, faces, body.nodes());
    const bool isStretched = stretch.m_start > kMostStretch || stretch.m_end > kMostStretch;
    if (isStretched && !body.m_heldTogether)
    {
        holdTogether(*body.m_body, faces, body.nodes());
        body.m_heldTogether = m_heldTogether = true;
        return;
    }
    m_mirrors[index]->startAnew();
    body.m_leftOut = body.m_wasTangled = true;
    body.m_contacts.m_limit.clear();
    if (!m_toldLeftOut.isNew(keyOf(*body.m_body))) return;
    char link[64] = "";
    if (isStretched)
        std::snprintf(link, sizeof(link), "; a link is %.3g times as long as at rest",
                      double(std::max(stretch.m_start, stretch.m_end)));
    m_state.log(m_state.nameOf(*body.m_body) +
                " needs more tests than a step may make, and does not collide in this step" + link);
}

// Marks cloths that collided with nothing in this step, or whose nodes were not all checked: they are checked before
// they count as guarded again.
void CollisionStep::markUnguarded()
{
    std::set<std::size_t> leftOut;  // a body has a mesh for each obstacle that deforms
    for (const MeshId cloth : m_state.pipeline().clothsLeftOut())
    {
        const auto found = m_byCloth.find(cloth);
        if (found != m_byCloth.end()) leftOut.insert(found->second);
    }
    for (const std::size_t index : leftOut)
        leaveOut(index);
    if (m_state.pipeline().statistics().m_invalidNodes == 0) return;
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        if (countInvalid(*m_bodies[i].m_body) == 0) continue;
        m_mirrors[i]->startAnew();
        m_invalid.insert(m_bodies[i].m_body);
    }
}

void CollisionStep::reportInvalid(const btSoftBody& body)
{
    if (m_invalid.empty() || m_invalid.count(&body) == 0 || contactsOf(body)) return;
    const std::size_t count = countInvalid(body);
    if (count == 0)
    {
        m_invalid.erase(&body);
        return;
    }
    m_state.m_statistics.m_status |= kStepInvalidNodes;
    m_state.m_statistics.m_invalidNodes += count;
}

void CollisionStep::reportLeftSurfaces()
{
    for (const Pair& pair : m_pairs)
    {
        const std::size_t body = m_byCloth.at(pair.m_cloth);
        if (pair.m_carriedStarts || m_bodies[body].m_leftOut || !meetsSurface(m_bodies[body])) continue;
        if (m_starts.endsMeeting(pair.m_start)) tellPassed(body);
    }
}

void CollisionStep::end()
{
    m_toldLeftOut.endStep();
    m_toldFields.endStep();
    for (const BodyContacts& body : m_bodies)
    {
        for (const NodePush& push : body.m_pushes)
        {
            btSoftBody::Node& node = body.m_body->m_nodes[push.m_node];
            const btScalar excess = node.m_v.dot(push.m_normal) - push.m_speedLimit;
            if (excess > 0) node.m_v -= push.m_normal * excess;
        }
        if (body.m_wasTangled) limitSpeeds(*body.m_body, body.m_leftOut);
    }
    for (std::size_t i = 0; i < m_mirrors.size(); ++i)
    {
        if (!m_bodies[i].m_isOnDevice) m_mirrors[i]->rememberEnds(m_state.threads());
    }
}
}  // namespace drape
