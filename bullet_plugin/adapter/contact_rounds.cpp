#include "bullet_plugin/adapter/contact_rounds.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace drape
{
namespace
{
// More than what the two ways of computing a violation round apart, as a share of the coordinates.
constexpr float kRounding = 256 * std::numeric_limits<float>::epsilon();

float largestCoordinate(const btVector3& v)
{
    return static_cast<float>(std::max(btFabs(v.x()), std::max(btFabs(v.y()), btFabs(v.z()))));
}

// A vector of Bullet's, the last number of which does not count, loaded and stored whole: a contact reads what the one
// before has just written, and a load waits for stores of less than itself to reach the cache.
using Quad = btScalar __attribute__((vector_size(4 * sizeof(btScalar))));

inline void load(const btVector3& vector, Quad& quad)
{
    std::memcpy(&quad, vector.m_floats, sizeof(quad));
}

inline void store(const Quad& quad, btVector3& vector)
{
    std::memcpy(vector.m_floats, &quad, sizeof(quad));
}

inline btScalar dot(const Quad& a, const Quad& b)
{
    const Quad products = a * b;
    return products[0] + products[1] + products[2];
}
}  // namespace

void ContactRounds::start(const BodyContacts& contacts, const FoundContacts& found)
{
    m_contacts = &contacts;
    m_found = &found;
    m_body = contacts.m_body;
    m_movedOfNode.assign(static_cast<std::size_t>(m_body->m_nodes.size()), -1);
    m_moved.clear();
    m_places.clear();
    m_farthest = 0;
    m_blocks.clear();
    m_rows.clear();
    m_holding.clear();
    m_nodeBlocks = 0;
    for (const FeatureContacts& feature : contacts.m_features)
    {
        addFeature(feature);
        if (feature.m_nodes[1] < 0) m_nodeBlocks = m_blocks.size();
    }
    m_margin = kRounding * (m_farthest + static_cast<float>(contacts.m_mostThickness));
    for (Block& block : m_blocks)
        for (float& level : block.m_level)
            level += m_margin;
    m_states.assign(m_blocks.size(), State());
}

void ContactRounds::addFeature(const FeatureContacts& feature)
{
    int moved[3], count = 0;
    for (int k = 0; k < 3; ++k)
    {
        const int node = feature.m_nodes[k] >= 0 ? feature.m_nodes[k] : feature.m_nodes[0];
        int& entry = m_movedOfNode[static_cast<std::size_t>(node)];
        if (entry < 0) entry = addMoved(node);
        moved[k] = entry;
        count += feature.m_nodes[k] >= 0 ? 1 : 0;
    }
    for (std::uint32_t first = 0; first < feature.m_count; first += kLanes)
    {
        m_blocks.emplace_back();
        Block& block = m_blocks.back();
        block.m_contacts = feature.m_contacts + first;
        block.m_lanes = static_cast<int>(std::min(feature.m_count - first, std::uint32_t(kLanes)));
        block.m_count = count;
        std::copy(moved, moved + 3, block.m_moved);
        for (int lane = 0; lane < kLanes; ++lane)
            fillLane(block, lane, block.m_contacts[std::min(lane, block.m_lanes - 1)]);
    }
}

void ContactRounds::fillLane(Block& block, int lane, const Contact& contact) const
{
    block.m_weights[0][lane] = contact.m_weights[1];
    block.m_weights[1][lane] = contact.m_weights[2];
    float level = static_cast<float>(m_contacts->m_mostThickness);
    for (int axis = 0; axis < 3; ++axis)
    {
        block.m_normal[axis][lane] = contact.m_normal[axis];
        level += contact.m_normal[axis] * contact.m_point[axis];
    }
    block.m_level[lane] = level;
}

int ContactRounds::addMoved(int node)
{
    const NodePaths& paths = m_contacts->m_limit.paths();
    const std::size_t at = static_cast<std::size_t>(node);
    m_places.push_back(Place{paths.m_end[at], paths.m_start[at]});
    m_moved.push_back(Moved{paths.m_inverseMass[at], node, false});
    m_farthest =
        std::max(m_farthest, std::max(largestCoordinate(paths.m_start[at]), largestCoordinate(paths.m_end[at])));
    return static_cast<int>(m_moved.size()) - 1;
}

ContactRounds::Row ContactRounds::makeRow(const Block& block, int lane) const
{
    const StepContact contact = m_found->resolve(*m_body, m_contacts->m_limit.paths(), block.m_contacts[lane]);
    Row row = Row();
    row.m_count = block.m_count;
    for (int k = 0; k < row.m_count; ++k)
    {
        row.m_moved[k] = block.m_moved[k];
        setWeight(row, k, contact.m_weights[k]);
    }
    row.m_normal = contact.m_normal;
    row.m_distance = contact.m_thickness + contact.m_targetGap;
    row.m_level = contact.m_normal.dot(contact.m_point) + row.m_distance;
    row.m_friction = contact.m_friction;
    row.m_held.setZero();
    row.m_carry = contact.m_carry;
    row.m_carried = carriedBy(row, row.m_carry);
    row.m_speedLimit = contact.m_startGap < 0
                           ? std::max(btScalar(0), (contact.m_endGap - contact.m_startGap) * m_body->m_sst.isdt) +
                                 row.m_normal.dot(row.m_carried) * m_body->m_sst.isdt
                           : SIMD_INFINITY;
    return row;
}

// Adds to the row's mobility.
void ContactRounds::setWeight(Row& row, int k, btScalar weight) const
{
    const btScalar inverseMass = m_moved[static_cast<std::size_t>(row.m_moved[k])].m_inverseMass;
    row.m_weights[k] = weight;
    row.m_shares[k] = weight * inverseMass;
    row.m_mobility += weight * weight * inverseMass;
}

bool ContactRounds::isViolated(const Row& row) const
{
    btVector3 point(0, 0, 0);
    for (int k = 0; k < row.m_count; ++k)
        point += m_places[static_cast<std::size_t>(row.m_moved[k])].m_x * row.m_weights[k];
    return row.m_level - row.m_normal.dot(point) > 0;
}

// Takes the contact's plane where its features are nearest now; the same plane for the block.
void ContactRounds::renewPlane(Row& row, Block& block, int lane) const
{
    float nodes[3][3];
    for (int k = 0; k < row.m_count; ++k)
        for (int axis = 0; axis < 3; ++axis)
            nodes[k][axis] = static_cast<float>(m_places[static_cast<std::size_t>(row.m_moved[k])].m_x[axis]);
    ContactPlane plane;
    if (!FoundContacts::planeAt(block.m_contacts[lane], nodes, plane)) return;
    row.m_renewed = true;
    row.m_mobility = 0;
    for (int k = 0; k < row.m_count; ++k)
        setWeight(row, k, plane.m_weights[k]);
    row.m_normal.setValue(plane.m_normal[0], plane.m_normal[1], plane.m_normal[2]);
    row.m_level = row.m_normal.dot(btVector3(plane.m_point[0], plane.m_point[1], plane.m_point[2])) + row.m_distance;
    row.m_carried = carriedBy(row, row.m_carry);
    for (int axis = 0; axis < 3; ++axis)
        block.m_normal[axis][lane] = plane.m_normal[axis];
    block.m_weights[0][lane] = plane.m_weights[1];
    block.m_weights[1][lane] = plane.m_weights[2];
    block.m_level[lane] = static_cast<float>(row.m_level) + m_margin;
}

btVector3 ContactRounds::carriedBy(const Row& row, const btTransform* carry) const
{
    btVector3 start(0, 0, 0);
    if (!carry) return start;
    for (int k = 0; k < row.m_count; ++k)
        start += m_places[static_cast<std::size_t>(row.m_moved[k])].m_start * row.m_weights[k];
    return *carry * start - start;
}

void ContactRounds::restart()
{
    ++m_stage;
    for (std::size_t index : m_holding)
    {
        State& state = m_states[index];
        for (int lane = 0; lane < kLanes; ++lane)
        {
            if (!(state.m_holding >> lane & 1u)) continue;
            Row& row = m_rows[static_cast<std::size_t>(state.m_row[lane])];
            row.m_multiplier = 0;
            row.m_held.setZero();
        }
        state.m_holding = 0;
    }
    m_holding.clear();
}

// Returns whether the contact had anything to do; `worst` grows to its violation.
bool ContactRounds::project(Row& row, btScalar& worst)
{
    if (row.m_count == 1) return projectNodes<1>(row, worst);
    return row.m_count == 2 ? projectNodes<2>(row, worst) : projectNodes<3>(row, worst);
}

template <int count>
bool ContactRounds::projectNodes(Row& row, btScalar& worst)
{
    Place* places[count];
    Quad x[count], point = {};
    for (int k = 0; k < count; ++k)
    {
        places[k] = &m_places[static_cast<std::size_t>(row.m_moved[k])];
        load(places[k]->m_x, x[k]);
        point += x[k] * row.m_weights[k];
    }
    Quad normal;
    load(row.m_normal, normal);
    const btScalar violation = row.m_level - dot(normal, point);
    if (!(violation > 0) && !(row.m_multiplier > 0)) return false;  // also for NaN
    worst = std::max(worst, violation);
    const btScalar pushed = std::max(btScalar(0), row.m_multiplier + violation / row.m_mobility);
    const Quad push = normal * (pushed - row.m_multiplier);
    Quad sliding = {};
    for (int k = 0; k < count; ++k)
    {
        x[k] += push * row.m_shares[k];
        sliding += x[k] * row.m_weights[k];
    }

    // Friction: takes the contact's motion along the surface back, within the cone.
    Quad other;
    load(row.m_carried, other);
    sliding -= other;
    for (int k = 0; k < count; ++k)
    {
        load(places[k]->m_start, other);
        sliding -= other * row.m_weights[k];
    }
    sliding -= normal * dot(normal, sliding);
    load(row.m_held, other);
    Quad held = other - sliding * (1 / row.m_mobility);
    const btScalar most = row.m_friction * pushed;
    const btScalar wanted2 = dot(held, held);
    if (wanted2 > most * most) held *= most / btSqrt(wanted2);
    const Quad hold = held - other;
    for (int k = 0; k < count; ++k)
    {
        store(x[k] + hold * row.m_shares[k], places[k]->m_x);
        m_moved[static_cast<std::size_t>(row.m_moved[k])].m_shifted = true;
    }
    row.m_multiplier = pushed;
    store(held, row.m_held);
    row.m_pushed = true;
    return true;
}

// The lanes whose contacts may be violated, a bit each: all that are, and some that nearly are.
inline unsigned ContactRounds::lanesDue(const Block& block, const Place* places)
{
    if (block.m_count == 1) return lanesDueOf<1>(block, places);
    return block.m_count == 2 ? lanesDueOf<2>(block, places) : lanesDueOf<3>(block, places);
}

template <int count>
inline unsigned ContactRounds::lanesDueOf(const Block& block, const Place* places)
{
    const btVector3& a = places[block.m_moved[0]].m_x;
    const btVector3& b = places[block.m_moved[1]].m_x;
    const btVector3& c = places[block.m_moved[2]].m_x;
    float excess[kLanes];
    for (int lane = 0; lane < kLanes; ++lane)
    {
        float along = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            const float x = float(a[axis]);
            float at = x;
            if (count > 1) at += block.m_weights[0][lane] * (float(b[axis]) - x);
            if (count > 2) at += block.m_weights[1][lane] * (float(c[axis]) - x);
            along += block.m_normal[axis][lane] * at;
        }
        excess[lane] = block.m_level[lane] - along;
    }
    if (!(std::max(std::max(excess[0], excess[1]), std::max(excess[2], excess[3])) > 0)) return 0;
    unsigned due = 0;
    for (int lane = 0; lane < block.m_lanes; ++lane)
        due |= excess[lane] > 0 ? 1u << lane : 0u;
    return due;
}

// Projects the contacts of a block that are due, in order. Returns the worst violation, 0 without one.
btScalar ContactRounds::projectBlock(std::size_t index, unsigned due)
{
    Block& block = m_blocks[index];
    State& state = m_states[index];
    const bool held = state.m_holding != 0;
    state.m_opened = true;
    btScalar worst = 0;
    for (int lane = 0; lane < block.m_lanes; ++lane)
    {
        if (!((due | state.m_holding) >> lane & 1u)) continue;
        if (state.m_row[lane] < 0)
        {
            state.m_row[lane] = static_cast<int>(m_rows.size());
            m_rows.push_back(makeRow(block, lane));
        }
        Row& row = m_rows[static_cast<std::size_t>(state.m_row[lane])];
        if (!(row.m_mobility > 0)) continue;
        if (row.m_stage != m_stage && isViolated(row))
        {
            renewPlane(row, block, lane);
            row.m_stage = m_stage;
        }
        if (!(row.m_mobility > 0) || !project(row, worst)) continue;
        state.m_holding |= 1u << lane;
        if (lane + 1 < block.m_lanes) due |= lanesDue(block, m_places.data());  // its nodes moved
    }
    if (!held && state.m_holding != 0) m_holding.push_back(index);
    return worst;
}

// Takes over where the body's nodes are now.
void ContactRounds::gather()
{
    for (std::size_t i = 0; i < m_moved.size(); ++i)
        m_places[i].m_x = m_body->m_nodes[m_moved[i].m_node].m_x;
}

void ContactRounds::scatter()
{
    const btScalar velocityScale = m_body->m_sst.isdt * (1 - m_body->m_cfg.kDP);
    for (std::size_t i = 0; i < m_moved.size(); ++i)
    {
        Moved& moved = m_moved[i];
        if (!moved.m_shifted) continue;
        moved.m_shifted = false;
        btSoftBody::Node& node = m_body->m_nodes[moved.m_node];
        node.m_v += (m_places[i].m_x - node.m_x) * velocityScale;
        node.m_x = m_places[i].m_x;
    }
}

btScalar ContactRounds::lookAtBlocks(std::size_t count)
{
    const Block* const blocks = m_blocks.data();
    const Place* const places = m_places.data();
    btScalar worst = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        const unsigned due = lanesDue(blocks[i], places) | m_states[i].m_holding;
        if (due != 0) worst = std::max(worst, projectBlock(i, due));
    }
    return worst;
}

btScalar ContactRounds::runBlocks(std::size_t count)
{
    gather();
    const btScalar worst = lookAtBlocks(count);
    scatter();
    return worst;
}

void ContactRounds::settle(const State& state)
{
    btScalar worst = 0;
    for (int lane = 0; lane < kLanes; ++lane)
    {
        if (!(state.m_holding >> lane & 1u)) continue;
        Row& row = m_rows[static_cast<std::size_t>(state.m_row[lane])];
        if (row.m_renewed) project(row, worst);
    }
}

void ContactRounds::runAndSettle()
{
    gather();
    lookAtBlocks(m_blocks.size());
    std::sort(m_holding.begin(), m_holding.end());  // in canonical order
    for (int pass = 0; pass < kSettlingPasses; ++pass)
        for (const std::size_t index : m_holding)
            settle(m_states[index]);
    scatter();
}

void ContactRounds::limitSpeed(const Row& row)
{
    btScalar speed = 0;
    for (int k = 0; k < row.m_count; ++k)
        speed += m_body->m_nodes[m_moved[static_cast<std::size_t>(row.m_moved[k])].m_node].m_v.dot(row.m_normal) *
                 row.m_weights[k];
    const btScalar excess = speed - row.m_speedLimit;
    if (!(excess > 0) || !(row.m_mobility > 0)) return;  // a plane taken anew may rest on pinned nodes alone
    for (int k = 0; k < row.m_count; ++k)
    {
        const Moved& moved = m_moved[static_cast<std::size_t>(row.m_moved[k])];
        m_body->m_nodes[moved.m_node].m_v -=
            row.m_normal * (row.m_weights[k] * moved.m_inverseMass * excess / row.m_mobility);
    }
}

void ContactRounds::limitSpeeds()
{
    for (const State& state : m_states)
        for (int lane = 0; state.m_opened && lane < kLanes; ++lane)
            if (state.m_row[lane] >= 0 && m_rows[static_cast<std::size_t>(state.m_row[lane])].m_pushed)
                limitSpeed(m_rows[static_cast<std::size_t>(state.m_row[lane])]);
}
}  // namespace drape
