#include "tests/unit/plain_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "bullet_plugin/core/solver/host/contact_group.h"

namespace drape::test
{
namespace
{
std::size_t nodeOf(const SolverContact& contact, int k)
{
    return std::size_t(contact.m_nodes[k]);
}
}  // namespace

PlainSweep::PlainSweep(const ClothContacts& cloth, const ContactSource& source, const std::vector<Contact>& contacts)
    : m_paths(cloth.m_nodes), m_perSecond(cloth.m_perSecond), m_leastThickness(cloth.m_leastThickness)
{
    for (std::size_t i = 0; i < m_paths.count(); ++i)
    {
        m_starts.push_back(m_paths.start(i));
        m_places.push_back(m_paths.displacement(i));
        m_velocities.push_back(m_paths.velocity(i));
    }
    for (const Contact& contact : contacts)
    {
        Row row;
        row.m_detected = contact;
        row.m_contact = cloth.resolve(source, contact);
        row.m_speedLimit = speedLimitOf(row.m_contact);
        m_rows.push_back(row);
    }
    sortRows(cloth);
}

// Sorts the contacts by group, children first, then by kind and colour. Each edge of the cloth has the least colour
// that no earlier edge of its group has at one of its nodes, and each face that no later face has.
void PlainSweep::sortRows(const ClothContacts& cloth)
{
    std::map<std::pair<std::size_t, std::uint32_t>, std::map<int, std::set<int>>> taken;
    const std::vector<OrderedFeature>& features = cloth.m_order->features();
    std::vector<int> colours(features.size());
    for (std::size_t k = 0; k < 2 * features.size(); ++k)
    {
        const bool isBack = k < features.size();
        const std::size_t i = isBack ? features.size() - 1 - k : k - features.size();
        const OrderedFeature& feature = features[i];
        if (isBack != (feature.m_kind == kFaceFeature)) continue;
        auto& nodes = taken[{cloth.m_parts->groupOf(feature.m_nodes), feature.m_kind}];
        int colour = 0;
        const auto isTaken = [&](int node) { return node >= 0 && nodes[node].count(colour) > 0; };
        while (std::any_of(feature.m_nodes, feature.m_nodes + 3, isTaken))
            ++colour;
        for (const int node : feature.m_nodes)
            nodes[node].insert(colour);
        colours[i] = colour;
    }
    for (Row& row : m_rows)
    {
        row.m_group = cloth.m_parts->groupOf(row.m_contact.m_nodes);
        row.m_colour = colours[row.m_detected.m_featureIndex];  // there is one cloth
    }
    const auto keyOf = [](const Row& row)
    { return std::make_tuple(-std::ptrdiff_t(row.m_group), kindOf(row.m_contact), row.m_colour); };
    std::stable_sort(m_rows.begin(), m_rows.end(), [&](const Row& a, const Row& b) { return keyOf(a) < keyOf(b); });
}

PlainSweep::Kind PlainSweep::kindOf(const SolverContact& contact)
{
    if (contact.m_nodes[1] < 0) return Kind::Node;
    return contact.m_nodes[2] < 0 ? Kind::Edge : Kind::Face;
}

void PlainSweep::restart(float passed, bool inTurns)
{
    m_passed = passed;
    m_inTurns = inTurns;
    for (Row& row : m_rows)
    {
        row.m_multiplier = 0;
        row.m_held = vec3(0, 0, 0);
        row.m_renewed = row.m_acted = false;
    }
}

float PlainSweep::sweep(std::initializer_list<Kind> kinds)
{
    float worst = 0;
    for (Row& row : m_rows)
    {
        if (std::find(kinds.begin(), kinds.end(), kindOf(row.m_contact)) == kinds.end()) continue;
        renewPlane(row);
        worst = std::max(worst, project(row));
    }
    return worst;
}

// Sweeps over the edges of each group, and then over the group's acting contacts.
float PlainSweep::sweepEdges()
{
    float worst = 0;
    for (std::size_t i = 0; i < m_rows.size(); ++i)
    {
        Row& row = m_rows[i];
        if (kindOf(row.m_contact) == Kind::Edge)
        {
            renewPlane(row);
            worst = std::max(worst, project(row));
        }
        if (i + 1 == m_rows.size() || m_rows[i + 1].m_group != row.m_group) sweepActing(row.m_group);
    }
    return worst;
}

void PlainSweep::sweepActing(std::size_t group)
{
    for (int i = 0; m_inTurns && i < DRAPE_ACTING_SWEEPS; ++i)
        for (Row& row : m_rows)
            if (row.m_group == group && row.m_acted) project(row);
}

void PlainSweep::addVelocities(const std::vector<Vec3>& before)
{
    for (std::size_t i = 0; i < m_places.size(); ++i)
        m_velocities[i] = vec3Add(m_velocities[i], vec3Scale(vec3Sub(m_places[i], before[i]), m_perSecond));
}

float PlainSweep::run()
{
    const std::vector<Vec3> before = m_places;
    const float first = sweep({Kind::Node, Kind::Face}), second = sweepEdges();
    addVelocities(before);
    return std::max(first, second);
}

float PlainSweep::runNodes()
{
    const std::vector<Vec3> before = m_places;
    const float worst = sweep({Kind::Node});
    addVelocities(before);
    return worst;
}

void PlainSweep::limitSpeeds()
{
    for (const bool edges : {false, true})
        for (const Row& row : m_rows)
            if ((kindOf(row.m_contact) == Kind::Edge) == edges) limitSpeed(row);
}

void PlainSweep::limitSpeed(const Row& row)
{
    const SolverContact& contact = row.m_contact;
    float speed = 0;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        speed += vec3Dot(m_velocities[nodeOf(contact, k)], contact.m_plane.m_normal) * contact.m_plane.m_weights[k];
    const float excess = speed - row.m_speedLimit, mobility = softenedOf(contact);
    if (!row.m_everActed || !(excess > 0) || !(mobility > 0)) return;
    ++m_slowed;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
    {
        Vec3& velocity = m_velocities[nodeOf(contact, k)];
        const float lost = shareOf(contact, k) * excess * (1 / mobility);
        velocity = vec3Sub(velocity, vec3Scale(contact.m_plane.m_normal, lost));
    }
}

bool PlainSweep::mayHavePassed() const
{
    const auto isNear = [this](const Row& row)
    {
        const float distance = row.m_contact.m_thickness + row.m_contact.m_gaps.m_target;
        return row.m_everActed && distance - violationOf(row.m_contact, 1) < kNearShare * m_leastThickness;
    };
    return std::any_of(m_rows.begin(), m_rows.end(), isNear);
}

std::size_t PlainSweep::pushed() const
{
    return std::size_t(
        std::count_if(m_rows.begin(), m_rows.end(), [](const Row& row) { return row.m_multiplier > 0; }));
}

Vec3 PlainSweep::pointOf(const SolverContact& contact, const std::vector<Vec3>& places) const
{
    Vec3 point = vec3(0, 0, 0);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        point = vec3Add(point, vec3Scale(places[nodeOf(contact, k)], contact.m_plane.m_weights[k]));
    return point;
}

// Returns the displacement that the obstacle's motion in the step gives to the contact's point of the cloth.
Vec3 PlainSweep::carriedFrom(const SolverContact& contact) const
{
    Vec3 carried = vec3(0, 0, 0);
    if (!contact.m_carry.moves()) return carried;
    carried = vec3Sub(carried, pointOf(contact, m_starts));
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
    {
        const Vec3 end = contact.m_carry.start(nodeOf(contact, k), m_starts[nodeOf(contact, k)]);
        carried = vec3Add(carried, vec3Scale(end, contact.m_plane.m_weights[k]));
    }
    return carried;
}

// Returns the outward speed that recovering a depth from before the step takes, beside the obstacle's own.
float PlainSweep::speedLimitOf(const SolverContact& contact) const
{
    if (!(contact.m_gaps.m_start < 0)) return std::numeric_limits<float>::infinity();
    const float recovered = std::max(0.0f, contact.m_gaps.m_end - contact.m_gaps.m_start);
    return (recovered + vec3Dot(contact.m_plane.m_normal, carriedFrom(contact))) * m_perSecond;
}

// The obstacle has moved by the share that has passed; the contact's plane is that at the step's end.
float PlainSweep::violationOf(const SolverContact& contact, float passed) const
{
    const Vec3 apart = vec3Sub(contact.m_plane.m_point, pointOf(contact, m_starts));
    const float level = vec3Dot(contact.m_plane.m_normal, apart) + (contact.m_thickness + contact.m_gaps.m_target);
    const float ahead = (1 - passed) * vec3Dot(contact.m_plane.m_normal, carriedFrom(contact));
    return level - ahead - vec3Dot(contact.m_plane.m_normal, pointOf(contact, m_places));
}

float PlainSweep::shareOf(const SolverContact& contact, int k) const
{
    return contact.m_plane.m_weights[k] * m_paths.inverseMass(nodeOf(contact, k));
}

float PlainSweep::mobilityOf(const SolverContact& contact) const
{
    float mobility = 0;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        mobility +=
            contact.m_plane.m_weights[k] * contact.m_plane.m_weights[k] * m_paths.inverseMass(nodeOf(contact, k));
    return mobility;
}

// Returns the share of the contact's point that belongs to fixed nodes, and in part to those that are ten times heavier
// than the lightest one.
float PlainSweep::heldShareOf(const SolverContact& contact) const
{
    float held = 0, most = 0;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        most = std::max(most, m_paths.inverseMass(nodeOf(contact, k)));
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        held += std::max(0.0f, 1 - m_paths.inverseMass(nodeOf(contact, k)) / (DRAPE_HEAVY_SHARE * most)) *
                contact.m_plane.m_weights[k];
    return held;
}

// Returns the mobility that pushes use. It exceeds its proportional value if a part of the point is held.
float PlainSweep::softenedOf(const SolverContact& contact) const
{
    float most = 0;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        most = std::max(most, m_paths.inverseMass(nodeOf(contact, k)));
    const float mobility = mobilityOf(contact);
    return mobility > 0 ? mobility + DRAPE_HELD_SOFTNESS * heldShareOf(contact) * most : 0.0f;
}

void PlainSweep::renewPlane(Row& row)
{
    SolverContact& contact = row.m_contact;
    if (row.m_renewed || !(mobilityOf(contact) > 0) || !(violationOf(contact, m_passed) > 0)) return;
    row.m_renewed = true;
    if (row.m_detected.m_kind != DRAPE_FACE_VERTEX || row.m_detected.m_time < 1) return;
    Vec3 nodes[3];
    for (int k = 0; k < 3; ++k)
    {
        // The obstacle counts as standing at the step's end, so the nodes take part in the rest of its motion. A link
        // repeats its second node.
        const std::size_t node = nodeOf(contact, contact.m_nodes[k] >= 0 ? k : k - 1);
        const Vec3 ahead = vec3Sub(contact.m_carry.start(node, m_starts[node]), m_starts[node]);
        nodes[k] = vec3Add(vec3Add(m_starts[node], m_places[node]), vec3Scale(ahead, 1 - m_passed));
    }
    ContactPlane plane;
    const Vec3 point = vec3Load(row.m_detected.m_point, 0), before = vec3Load(row.m_detected.m_normal, 0);
    if (!planeOfFace(nodes, point, before, &plane)) return;
    ++m_renewals;
    if (contact.m_nodes[2] < 0) joinCorners(plane.m_weights);
    contact.m_plane = plane;
}

// Returns the part of the violation that the push corrects.
float PlainSweep::project(Row& row)
{
    const SolverContact& contact = row.m_contact;
    const Vec3 normal = contact.m_plane.m_normal;
    const float mobility = softenedOf(contact), violation = violationOf(contact, m_passed);
    if (!(mobility > 0) || (!(violation > 0) && !(row.m_multiplier > 0))) return 0;
    if (!row.m_acted && !(violationOf(contact, 1) > 0)) ++m_early;
    row.m_acted = row.m_everActed = true;
    const float inverse = 1 / mobility;
    const float pushed =
        std::max(0.0f, row.m_multiplier + (m_inTurns ? DRAPE_TURN_RELAXATION : 1.0f) * violation * inverse);

    const Vec3 way = pointOf(contact, m_places), carried = carriedFrom(contact);
    const Vec3 slid = vec3Sub(way, vec3Scale(normal, vec3Dot(normal, way)));
    const Vec3 slidObstacle = vec3Sub(carried, vec3Scale(normal, vec3Dot(normal, carried)));
    const Vec3 relative = vec3Sub(slid, vec3Scale(slidObstacle, m_passed));
    Vec3 held = vec3Sub(row.m_held, vec3Scale(relative, inverse));
    const float most = contact.m_friction * pushed, wanted2 = vec3Dot(held, held);
    if (wanted2 > most * most) held = vec3Scale(held, most / std::sqrt(wanted2));

    const Vec3 impulse = vec3Add(vec3Scale(normal, pushed - row.m_multiplier), vec3Sub(held, row.m_held));
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        move(nodeOf(contact, k), vec3Scale(impulse, shareOf(contact, k)));
    row.m_multiplier = pushed;
    row.m_held = held;
    return heldShareOf(contact) > 0 ? violation * (mobilityOf(contact) * inverse) : violation;
}
}  // namespace drape::test
