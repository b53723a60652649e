#include "bullet_plugin/adapter/contact_rounds.h"

#include <algorithm>
#include <cstdint>
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

// What the obstacle's motion in the step does to a point, m.
btVector3 carriedFrom(const btVector3& start, const btTransform* carry)
{
    return carry ? *carry * start - start : btVector3(0, 0, 0);
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

// For blocks, which are in float32.
inline ContactRounds::Lanes lanesOf(const btVector3& vector)
{
    Quad quad;
    load(vector, quad);
    return __builtin_convertvector(quad, ContactRounds::Lanes);
}

inline btScalar dot(const Quad& a, const Quad& b)
{
    const Quad products = a * b;
    return products[0] + products[1] + products[2];
}

inline bool anyAbove0(const ContactRounds::Lanes& values)
{
    const auto above = values > 0;
    std::uint64_t halves[2];
    std::memcpy(halves, &above, sizeof(above));
    return (halves[0] | halves[1]) != 0;
}

// A bit for each lane that is above 0.
inline unsigned bitsAbove0(const ContactRounds::Lanes& values)
{
    static_assert(ContactRounds::kLanes == 4 && sizeof(int) == sizeof(float));
    using Bits = int __attribute__((vector_size(sizeof(values))));
    const Bits bits = (values > 0) & Bits{1, 2, 4, 8};
    std::uint64_t halves[2];
    std::memcpy(halves, &bits, sizeof(bits));
    const std::uint64_t both = halves[0] | halves[1];
    return static_cast<unsigned>(both | both >> 32);
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
        block.m_level += m_margin;
    m_rowsOf.assign(m_blocks.size(), BlockRows());
    m_holds.assign(m_blocks.size(), 0);
    m_shifted.assign(m_moved.size(), 0);
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
        const int lanes = static_cast<int>(std::min(feature.m_count - first, std::uint32_t(kLanes)));
        block.m_lanes = lanes;
        block.m_count = count;
        std::copy(moved, moved + 3, block.m_moved);
        for (int lane = 0; lane < kLanes; ++lane)
            fillLane(block, lane, block.m_contacts[std::min(lane, lanes - 1)]);
        for (int lane = lanes; lane < kLanes; ++lane)
            block.m_level[lane] = -std::numeric_limits<float>::infinity();
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
    m_places.push_back(paths.m_end[at]);
    m_moved.push_back(Moved{paths.m_inverseMass[at], node});
    m_farthest =
        std::max(m_farthest, std::max(largestCoordinate(paths.m_start[at]), largestCoordinate(paths.m_end[at])));
    return static_cast<int>(m_moved.size()) - 1;
}

ContactRounds::Row ContactRounds::makeRow(const Block& block, int lane) const
{
    const StepContact contact = m_found->resolve(*m_body, m_contacts->m_limit.paths(), block.m_contacts[lane]);
    Row row = Row();
    row.m_count = block.m_count;
    std::copy(block.m_moved, block.m_moved + 3, row.m_moved);
    row.m_held.setZero();
    row.m_friction = contact.m_friction;
    row.m_distance = contact.m_thickness + contact.m_targetGap;
    row.m_carry = contact.m_carry;
    setPlane(row, contact.m_weights, contact.m_normal, contact.m_point);
    row.m_speedLimit = SIMD_INFINITY;
    if (contact.m_startGap < 0)
    {
        const btScalar recovered = std::max(btScalar(0), contact.m_endGap - contact.m_startGap);
        row.m_speedLimit = (recovered + row.m_normal.dot(carriedFrom(row.m_start, row.m_carry))) * m_body->m_sst.isdt;
    }
    return row;
}

// Of the row's point of the cloth.
btVector3 ContactRounds::startOf(const Row& row) const
{
    const std::vector<btVector3>& starts = m_contacts->m_limit.paths().m_start;
    btVector3 start(0, 0, 0);
    for (int k = 0; k < row.m_count; ++k)
    {
        const int node = m_moved[static_cast<std::size_t>(row.m_moved[k])].m_node;
        start += starts[static_cast<std::size_t>(node)] * row.m_weights[k];
    }
    return start;
}

void ContactRounds::setPlane(Row& row, const btScalar weights[3], const btVector3& normal, const btVector3& point) const
{
    btScalar mobility = 0;
    for (int k = 0; k < row.m_count; ++k)
    {
        const btScalar inverseMass = m_moved[static_cast<std::size_t>(row.m_moved[k])].m_inverseMass;
        row.m_weights[k] = weights[k];
        row.m_shares[k] = weights[k] * inverseMass;
        mobility += weights[k] * weights[k] * inverseMass;
    }
    row.m_inverseMobility = mobility > 0 ? 1 / mobility : btScalar(0);
    row.m_normal = normal;
    row.m_start = startOf(row);
    const btVector3 carried = carriedFrom(row.m_start, row.m_carry);
    row.m_carried = carried - normal * normal.dot(carried);
    row.m_level = normal.dot(point - row.m_start) + row.m_distance;
}

bool ContactRounds::isViolated(const Row& row) const
{
    btVector3 way = -row.m_start;
    for (int k = 0; k < row.m_count; ++k)
        way += m_places[static_cast<std::size_t>(row.m_moved[k])] * row.m_weights[k];
    return row.m_level - row.m_normal.dot(way) > 0;
}

// Takes the contact's plane where its features are nearest now; the same plane for the block.
void ContactRounds::renewPlane(Row& row, Block& block, int lane) const
{
    float nodes[3][3];
    for (int k = 0; k < row.m_count; ++k)
        for (int axis = 0; axis < 3; ++axis)
            nodes[k][axis] = static_cast<float>(m_places[static_cast<std::size_t>(row.m_moved[k])][axis]);
    ContactPlane plane;
    if (!FoundContacts::planeAt(block.m_contacts[lane], nodes, plane)) return;
    row.m_renewed = true;
    const btScalar weights[3] = {plane.m_weights[0], plane.m_weights[1], plane.m_weights[2]};
    const btVector3 point(plane.m_point[0], plane.m_point[1], plane.m_point[2]);
    setPlane(row, weights, btVector3(plane.m_normal[0], plane.m_normal[1], plane.m_normal[2]), point);
    for (int axis = 0; axis < 3; ++axis)
        block.m_normal[axis][lane] = plane.m_normal[axis];
    block.m_weights[0][lane] = plane.m_weights[1];
    block.m_weights[1][lane] = plane.m_weights[2];
    block.m_level[lane] = static_cast<float>(row.m_normal.dot(point) + row.m_distance) + m_margin;
}

void ContactRounds::restart()
{
    ++m_stage;
    for (const std::size_t index : m_holding)
    {
        for (int lane = 0; lane < kLanes; ++lane)
        {
            if (!(m_holds[index] >> lane & 1)) continue;
            Row& row = m_rows[static_cast<std::size_t>(m_rowsOf[index].m_row[lane])];
            row.m_multiplier = 0;
            row.m_held.setZero();
        }
        m_holds[index] = 0;
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
    btVector3* places[count];
    Quad x[count], way, normal, held, carried;
    load(row.m_normal, normal);
    load(row.m_held, held);
    load(row.m_carried, carried);
    load(row.m_start, way);
    way = -way;
    for (int k = 0; k < count; ++k)
    {
        places[k] = &m_places[static_cast<std::size_t>(row.m_moved[k])];
        load(*places[k], x[k]);
        way += x[k] * row.m_weights[k];
    }
    const btScalar along = dot(normal, way), violation = row.m_level - along;
    if (!(violation > 0) && !(row.m_multiplier > 0)) return false;  // also for NaN
    worst = std::max(worst, violation);
    const btScalar pushed = std::max(btScalar(0), row.m_multiplier + violation * row.m_inverseMobility);
    // Friction: takes the point's motion along the surface back, within the cone. A push leaves that motion as it is.
    Quad hold = held - (way - normal * along - carried) * row.m_inverseMobility;
    const btScalar most = row.m_friction * pushed;
    const btScalar wanted2 = dot(hold, hold);
    if (wanted2 > most * most) hold *= most / btSqrt(wanted2);
    const Quad shift = normal * (pushed - row.m_multiplier) + (hold - held);
    for (int k = 0; k < count; ++k)
    {
        const std::size_t moved = static_cast<std::size_t>(row.m_moved[k]);
        store(x[k] + shift * row.m_shares[k], *places[k]);
        m_shifted[moved] = 1;
    }
    row.m_multiplier = pushed;
    store(hold, row.m_held);
    row.m_pushed = true;
    return true;
}

// How far each lane's contact may be violated, m: no less than it is.
inline ContactRounds::Lanes ContactRounds::excessOf(const Block& block, const btVector3* places)
{
    if (block.m_count == 1) return excessOfNodes<1>(block, places);
    return block.m_count == 2 ? excessOfNodes<2>(block, places) : excessOfNodes<3>(block, places);
}

template <int count>
inline ContactRounds::Lanes ContactRounds::excessOfNodes(const Block& block, const btVector3* places)
{
    const Lanes a = lanesOf(places[block.m_moved[0]]);
    Lanes at[3] = {__builtin_shufflevector(a, a, 0, 0, 0, 0), __builtin_shufflevector(a, a, 1, 1, 1, 1),
                   __builtin_shufflevector(a, a, 2, 2, 2, 2)};
    for (int k = 1; k < count; ++k)
    {
        const Lanes way = lanesOf(places[block.m_moved[k]]) - a;
        at[0] += block.m_weights[k - 1] * __builtin_shufflevector(way, way, 0, 0, 0, 0);
        at[1] += block.m_weights[k - 1] * __builtin_shufflevector(way, way, 1, 1, 1, 1);
        at[2] += block.m_weights[k - 1] * __builtin_shufflevector(way, way, 2, 2, 2, 2);
    }
    return block.m_level - (block.m_normal[0] * at[0] + block.m_normal[1] * at[1] + block.m_normal[2] * at[2]);
}

// Projects the contacts of a block that are due, in order: those that push and those that may be violated. Returns the
// worst violation, 0 without one.
btScalar ContactRounds::projectBlock(std::size_t index, unsigned due)
{
    Block& block = m_blocks[index];
    const unsigned held = m_holds[index];
    unsigned holds = held;
    btScalar worst = 0;
    for (int lane = 0; lane < kLanes; ++lane)
    {
        if (!(due >> lane & 1u)) continue;
        int& at = m_rowsOf[index].m_row[lane];
        if (at < 0)
        {
            at = static_cast<int>(m_rows.size());
            m_rows.push_back(makeRow(block, lane));
        }
        Row& row = m_rows[static_cast<std::size_t>(at)];
        if (!(row.m_inverseMobility > 0)) continue;
        if (row.m_stage != m_stage && isViolated(row))
        {
            renewPlane(row, block, lane);
            row.m_stage = m_stage;
        }
        if (!(row.m_inverseMobility > 0) || !project(row, worst)) continue;
        holds |= 1u << lane;
        if (lane + 1 < block.m_lanes) due |= bitsAbove0(excessOf(block, m_places.data()));  // its nodes moved
    }
    m_holds[index] = static_cast<unsigned char>(holds);
    if (held == 0 && holds != 0) m_holding.push_back(index);
    return worst;
}

// Takes over where the body's nodes are now.
void ContactRounds::gather()
{
    for (std::size_t i = 0; i < m_moved.size(); ++i)
        m_places[i] = m_body->m_nodes[m_moved[i].m_node].m_x;
}

void ContactRounds::scatter()
{
    const btScalar velocityScale = m_body->m_sst.isdt * (1 - m_body->m_cfg.kDP);
    for (std::size_t i = 0; i < m_moved.size(); ++i)
    {
        if (!m_shifted[i]) continue;
        m_shifted[i] = 0;
        btSoftBody::Node& node = m_body->m_nodes[m_moved[i].m_node];
        node.m_v += (m_places[i] - node.m_x) * velocityScale;
        node.m_x = m_places[i];
    }
}

btScalar ContactRounds::lookAtBlocks(std::size_t count)
{
    const Block* const blocks = m_blocks.data();
    const btVector3* const places = m_places.data();
    const unsigned char* const holds = m_holds.data();
    btScalar worst = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        const Lanes excess = excessOf(blocks[i], places);
        if (holds[i] != 0 || anyAbove0(excess)) worst = std::max(worst, projectBlock(i, bitsAbove0(excess) | holds[i]));
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

void ContactRounds::settle()
{
    std::sort(m_holding.begin(), m_holding.end());  // in canonical order
    m_settling.clear();
    for (const std::size_t index : m_holding)
    {
        for (int lane = 0; lane < kLanes; ++lane)
        {
            if (!(m_holds[index] >> lane & 1)) continue;
            Row& row = m_rows[static_cast<std::size_t>(m_rowsOf[index].m_row[lane])];
            if (row.m_renewed) m_settling.push_back(&row);
        }
    }
    btScalar worst = 0;
    for (int pass = 0; pass < kSettlingPasses; ++pass)
        for (Row* row : m_settling)
            project(*row, worst);
}

void ContactRounds::runAndSettle()
{
    gather();
    lookAtBlocks(m_blocks.size());
    settle();
    scatter();
}

void ContactRounds::limitSpeed(const Row& row)
{
    btScalar speed = 0;
    for (int k = 0; k < row.m_count; ++k)
        speed += m_body->m_nodes[m_moved[static_cast<std::size_t>(row.m_moved[k])].m_node].m_v.dot(row.m_normal) *
                 row.m_weights[k];
    const btScalar excess = speed - row.m_speedLimit;
    if (!(excess > 0) || !(row.m_inverseMobility > 0)) return;  // a plane taken anew may rest on pinned nodes alone
    for (int k = 0; k < row.m_count; ++k)
    {
        const Moved& moved = m_moved[static_cast<std::size_t>(row.m_moved[k])];
        m_body->m_nodes[moved.m_node].m_v -= row.m_normal * (row.m_shares[k] * excess * row.m_inverseMobility);
    }
}

void ContactRounds::limitSpeeds()
{
    for (const BlockRows& rows : m_rowsOf)
        for (const int row : rows.m_row)
            if (row >= 0 && m_rows[static_cast<std::size_t>(row)].m_pushed)
                limitSpeed(m_rows[static_cast<std::size_t>(row)]);
}
}  // namespace drape
