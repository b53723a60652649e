#include "cloth_rows.h"

#include <algorithm>
#include <numeric>

#include "kernels/lib/cloth_cloth/self_contact.h"
#include "kernels/lib/solver/acting_contact.h"

namespace drape
{
namespace
{
// Distance between two features, as a share of the thickness, below which the direction between them is not sure.
constexpr float kSureDistance = 0.01f;

// Distance beyond the resting one, as a share of the thickness, within which features may meet in a phase's sweeps.
constexpr float kNearBy = 0.25f;

// Share of a substep's pushes with which the next one starts. Those that recover a depth are among them: a stack that
// starts with all of them hops.
constexpr float kRepeatedShare = 0.5f;

// Parts of the nodes: more than threads, so that all have work.
constexpr std::size_t kParts = 32;

// Writes the weights of the nearest points of two features: positive for the first one's nodes, negative for the
// second's. positions: m.
void nearestWeights(const Vec3 positions[4], int split, float weights[4])
{
    if (split == 1)
    {
        FeatureTriangle face;
        for (int i = 0; i < 3; ++i)
            face.m_p[i] = vec3Sub(positions[1 + i], positions[0]);
        const int thin = isThin(face, vec3Length(triangleNormal(face)));
        const Vec3 at = closestOnFace(vec3(0.0f, 0.0f, 0.0f), face, thin);
        const float all[4] = {1.0f, -at.x, -at.y, -at.z};
        std::copy(all, all + 4, weights);
        return;
    }
    float s, t;
    edgesClosest(edgesFrom(positions), &s, &t);
    const float all[4] = {1.0f - s, s, t - 1.0f, -t};
    std::copy(all, all + 4, weights);
}
}  // namespace

void ClothRows::clear(bool keeps)
{
    m_kept.resize(keeps ? m_rows.size() : 0);
    const auto keep = [this](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
            m_kept[m_rows[i].m_order] = m_rows[i].m_kept;
    };
    forRanges(m_kept.size(), kLeastShared, kRange, &m_threads, keep);
    m_rows.clear();
    m_time = 0;
}

// Returns how many nodes a part has.
std::size_t ClothRows::partSize(std::size_t rows, std::size_t nodes)
{
    const std::size_t parts = rows >= kLeastShared ? kParts : 1;
    return (nodes + parts - 1) / parts;
}

// Writes a contact's row. Returns its group.
std::uint32_t ClothRows::takeRow(const ClothContact& contact, Row& row)
{
    row = {};
    row.m_kept.m_key = contact.m_key;
    for (int k = 0; k < 4; ++k)
    {
        SolverNodes* const cloth = contact.m_cloths[k];
        const std::uint32_t node = contact.m_nodes[k];
        row.m_cloths[k] = cloth;
        row.m_nodes[k] = cloth ? cloth->nodes() + node : &m_fixed;
        row.m_states[k] = cloth ? cloth->states() + node : &m_fixedState;
        row.m_starts[k] = cloth ? cloth->start(node) : contact.m_resting[k];
        row.m_inverseMasses[k] = cloth ? cloth->inverseMass(node) : 0.0f;
        row.m_ids[k] = contact.m_ids[k];
    }
    const float gap = contact.m_gap0 - contact.m_thickness;
    row.m_split = contact.m_split;
    row.m_index = contact.m_index;
    row.m_gap0 = contact.m_gap0;
    row.m_thickness = contact.m_thickness;
    row.m_distance = contact.m_thickness + targetGap(gap, 0.0f, contact.m_thickness);
    row.m_normal = contact.m_normal;
    row.m_friction = contact.m_friction;
    return groupOf(row);
}

ThreadTeam* ClothRows::threads() const
{
    return m_climb.leafCount() > 1 ? &m_threads : nullptr;
}

// Returns the group of the parts that have the row's moving nodes.
std::uint32_t ClothRows::groupOf(const Row& row) const
{
    std::size_t group = 0;
    for (int k = 0; k < 4; ++k)
    {
        if (!(row.m_inverseMasses[k] > 0.0f)) continue;
        const std::size_t leaf = m_parts.leafOf(int(row.m_ids[k]));
        group = group == 0 ? leaf : ClothParts::commonGroup(group, leaf);
    }
    return std::uint32_t(std::max<std::size_t>(group, 1));
}

// Gives the contacts of a range the pushes of the same pairs' rows in the last step.
void ClothRows::findKept(std::size_t first, std::size_t last)
{
    const auto isBefore = [](const Kept& kept, std::uint64_t key) { return kept.m_key < key; };
    auto kept = m_kept.cend();
    for (std::size_t i = first; i < last; ++i)
    {
        if (m_groupOf[i] == 0) continue;
        Row& row = m_unordered[i];
        if (i == first || kept == m_kept.cend())
            kept = std::lower_bound(m_kept.cbegin(), m_kept.cend(), row.m_kept.m_key, isBefore);
        while (kept != m_kept.cend() && kept->m_key < row.m_kept.m_key)
            ++kept;
        if (kept != m_kept.cend() && kept->m_key == row.m_kept.m_key) row.m_kept = *kept;
    }
}

// Orders the rows by group, and within one as the contacts.
void ClothRows::arrange()
{
    m_climb.resize(m_parts.leafCount());
    m_firsts.assign(m_parts.groupCount() + 1, 0);
    for (const std::uint32_t group : m_groupOf)
        if (group != 0) ++m_firsts[group + 1];
    std::partial_sum(m_firsts.begin(), m_firsts.end(), m_firsts.begin());
    m_actingEnds.assign(m_firsts.begin(), m_firsts.end() - 1);
    m_placeOf.resize(m_groupOf.size());
    m_orderOf.resize(m_groupOf.size());
    std::uint32_t order = 0;
    for (std::size_t i = 0; i < m_groupOf.size(); ++i)
    {
        if (m_groupOf[i] == 0) continue;
        m_placeOf[i] = std::uint32_t(m_actingEnds[m_groupOf[i]]++);
        m_orderOf[i] = order++;
    }
    m_rows.resize(order);
    const auto put = [this](std::size_t first, std::size_t last)
    {
        findKept(first, last);
        for (std::size_t i = first; i < last; ++i)
        {
            if (m_groupOf[i] == 0) continue;
            Row& row = m_rows[m_placeOf[i]] = m_unordered[i];
            row.m_order = m_orderOf[i];
        }
    };
    forRanges(m_groupOf.size(), kLeastShared, kRange, &m_threads, put);
    m_actingEnds.assign(m_firsts.begin(), m_firsts.end() - 1);
    m_acting.resize(m_rows.size());
    m_actingRows.resize(m_rows.size());
    m_worst.resize(m_parts.groupCount());
}

// Takes the row's plane between the nearest points of the features as they are.
ClothRows::Acting ClothRows::takePlane(Row& row, float passed)
{
    Acting acting = {};
    Vec3 positions[4], offset = vec3(0.0f, 0.0f, 0.0f), apart = offset;
    for (int k = 0; k < 4; ++k)
        positions[k] = vec3Add(row.m_starts[k], row.m_nodes[k]->m_displacement);
    nearestWeights(positions, row.m_split, row.m_weights);
    float mobility = 0.0f;
    for (int k = 0; k < 4; ++k)
    {
        // Weights add up to 0: offsets from one node have less rounding than positions.
        apart = vec3AddScaled(apart, vec3Sub(positions[k], positions[0]), row.m_weights[k]);
        offset = vec3AddScaled(offset, vec3Sub(row.m_starts[k], row.m_starts[0]), row.m_weights[k]);
        mobility += row.m_weights[k] * row.m_weights[k] * row.m_inverseMasses[k];
        acting.m_nodes[k] = row.m_nodes[k];
        acting.m_weights[k] = row.m_weights[k];
        acting.m_shares[k] = row.m_weights[k] * row.m_inverseMasses[k];
    }
    const float distance = vec3Length(apart);
    if (distance > kSureDistance * row.m_thickness)
    {
        // Features pass each other where both are nearest inside. A node beside a face went around it.
        const bool inside = std::all_of(row.m_weights, row.m_weights + 4, [](float weight) { return weight != 0.0f; });
        const bool hasPassed = inside && vec3Dot(apart, row.m_normal) < 0.0f;
        row.m_normal = vec3Scale(apart, (hasPassed ? -1.0f : 1.0f) / distance);
    }
    row.m_inverseMobility = mobility > 0.0f ? 1.0f / mobility : 0.0f;
    const float distance0 = std::min(row.m_gap0, row.m_distance);
    acting.m_normal = row.m_normal;
    acting.m_level = distance0 + passed * (row.m_distance - distance0) - vec3Dot(row.m_normal, offset);
    acting.m_inverseMobility = row.m_inverseMobility;
    acting.m_friction = row.m_friction;
    acting.m_thickness = row.m_thickness;
    return acting;
}

// Returns the displacement of one feature's point from the other's, m.
Vec3 ClothRows::wayOf(const Acting& acting)
{
    Vec3 way = vec3(0.0f, 0.0f, 0.0f);
    for (int k = 0; k < 4; ++k)
        way = vec3AddScaled(way, acting.m_nodes[k]->m_displacement, acting.m_weights[k]);
    return way;
}

// Sets the pushes with which a substep of `time` seconds starts.
void ClothRows::repeat(const Row& row, float time, Acting& acting)
{
    const float scale = kRepeatedShare * time * time;
    acting.m_multiplier = scale * row.m_kept.m_push;
    const Vec3 held = vec3Scale(row.m_kept.m_held, scale);
    acting.m_held = vec3AddScaled(held, acting.m_normal, -vec3Dot(held, acting.m_normal));
}

void ClothRows::begin(float passed, float time)
{
    const auto beginGroup = [&](std::size_t group)
    {
        std::size_t& end = m_actingEnds[group] = m_firsts[group];
        for (std::size_t i = m_firsts[group]; i < m_firsts[group + 1]; ++i)
        {
            Row& row = m_rows[i];
            Acting& acting = m_acting[end] = takePlane(row, passed);
            const bool isNear = acting.m_level - vec3Dot(acting.m_normal, wayOf(acting)) > -kNearBy * row.m_thickness;
            const bool acts = isNear && acting.m_inverseMobility > 0.0f;
            if (acts) m_actingRows[end++] = std::uint32_t(i);
            if (!(time > 0.0f)) continue;
            if (acts) repeat(row, time, acting);
            row.m_kept.m_push = 0.0f;
            row.m_kept.m_held = vec3(0.0f, 0.0f, 0.0f);
        }
    };
    m_climb.run(threads(), beginGroup);
    m_time = time;
    if (!(time > 0.0f)) return;
    const auto push = [](Acting& acting, std::uint32_t)
    {
        if (acting.m_multiplier > 0.0f)
            shift(acting, vec3AddScaled(acting.m_held, acting.m_normal, acting.m_multiplier));
    };
    m_climb.run(threads(), [&](std::size_t group) { forActing(group, push); });
}

// Moves the row's nodes. by: kg m.
void ClothRows::shift(Acting& acting, Vec3 by)
{
    for (int k = 0; k < 4; ++k)
        if (acting.m_shares[k] != 0.0f)
            acting.m_nodes[k]->m_displacement =
                vec3AddScaled(acting.m_nodes[k]->m_displacement, by, acting.m_shares[k]);
    acting.m_hasMoved = 1;
}

void ClothRows::project(int sweeps, float relaxation, float tolerated, float enough)
{
    const auto projectGroup = [&](std::size_t group)
    {
        float worst = 0.0f;
        const auto projectRow = [&](Acting& acting, std::uint32_t)
        {
            const Vec3 way = wayOf(acting);
            const float along = vec3Dot(acting.m_normal, way);
            const float violation = acting.m_level - along, excess = violation - tolerated * acting.m_thickness;
            if (!(excess > 0.0f) && !(acting.m_multiplier > 0.0f)) return;
            worst = std::max(worst, violation / acting.m_thickness);
            shift(acting, pushPlane(acting.m_normal, vec3AddScaled(way, acting.m_normal, -along),
                                    relaxation * excess * acting.m_inverseMobility, acting.m_inverseMobility,
                                    acting.m_friction, &acting.m_multiplier, &acting.m_held));
        };
        forActing(group, projectRow);
        m_worst[group] = worst;
    };
    for (int i = 0; i < sweeps; ++i)
    {
        m_climb.run(threads(), projectGroup);
        if (*std::max_element(m_worst.begin() + 1, m_worst.end()) <= enough) return;
    }
}

// Keeps a part of the phase's push out of the nodes' velocities where their cloths ask for it.
void ClothRows::sharePush(const Row& row, const Acting& acting, Vec3 push)
{
    for (int k = 0; k < 4; ++k)
    {
        if (acting.m_shares[k] == 0.0f || row.m_cloths[k]->pushShare() == 1.0f) continue;
        const float kept = acting.m_shares[k] * (1.0f - row.m_cloths[k]->pushShare());
        row.m_states[k]->m_before = vec3AddScaled(row.m_states[k]->m_before, push, kept);
    }
}

// Adds what the phase pushed to the row's impulse, and keeps it as forces if the phase had a time.
void ClothRows::endRow(Row& row, const Acting& acting, float perPush) const
{
    if (acting.m_hasMoved)
        for (int k = 0; k < 4; ++k)
            if (acting.m_shares[k] != 0.0f) row.m_states[k]->m_shifted |= DRAPE_NODE_SHIFTED;
    const Vec3 push = vec3AddScaled(acting.m_held, acting.m_normal, acting.m_multiplier);
    sharePush(row, acting, push);
    if (acting.m_multiplier > 0.0f) row.m_impulse = vec3AddScaled(row.m_impulse, push, perPush);
    if (!(m_time > 0.0f)) return;
    const float perSquare = 1.0f / (m_time * m_time);
    row.m_kept.m_push = acting.m_multiplier * perSquare;
    row.m_kept.m_held = vec3Scale(acting.m_held, perSquare);
}

void ClothRows::end(float perPush)
{
    const auto endOne = [&](const Acting& acting, std::uint32_t row) { endRow(m_rows[row], acting, perPush); };
    m_climb.run(threads(), [&](std::size_t group) { forActing(group, endOne); });
}

// Removes from the nodes' velocities what the row gained; see limitSpeeds().
void ClothRows::limitSpeed(Row& row, float perSecond)
{
    const float recovered = row.m_distance - row.m_gap0;
    if (!(row.m_gap0 < row.m_thickness) || !(row.m_inverseMobility > 0.0f)) return;
    float speed = 0.0f;
    for (int k = 0; k < 4; ++k)
        speed += row.m_weights[k] * vec3Dot(row.m_states[k]->m_velocity, row.m_normal);
    const float excess = std::min(speed, std::max(0.0f, recovered) * perSecond);
    if (!(excess > 0.0f)) return;
    const Vec3 loss = vec3Scale(row.m_normal, -excess * row.m_inverseMobility);
    row.m_impulse = vec3Add(row.m_impulse, loss);
    for (int k = 0; k < 4; ++k)
        if (row.m_inverseMasses[k] > 0.0f)
            row.m_states[k]->m_velocity =
                vec3AddScaled(row.m_states[k]->m_velocity, loss, row.m_weights[k] * row.m_inverseMasses[k]);
}

void ClothRows::limitSpeeds(float perSecond)
{
    const auto limitGroup = [&](std::size_t group)
    {
        for (std::size_t i = m_firsts[group]; i < m_firsts[group + 1]; ++i)
            limitSpeed(m_rows[i], perSecond);
    };
    m_climb.run(threads(), limitGroup);
}
}  // namespace drape
