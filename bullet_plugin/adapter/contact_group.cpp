#include "bullet_plugin/adapter/contact_group.h"

#include <algorithm>
#include <limits>

#include "kernels/lib/segment.h"

namespace drape
{
void ContactGroup::clear()
{
    m_features.clear();
    m_blocks.clear();
    m_nodeBlocks = m_faceBlocks = 0;
    m_rows.clear();
    m_holding.clear();
    m_settling.clear();
}

void ContactGroup::makeBlocks(const RoundsNodes& nodes)
{
    for (const FeatureContacts* feature : m_features)
    {
        addFeature(nodes, *feature);
        if (feature->m_nodes[1] < 0) m_nodeBlocks = m_faceBlocks = m_blocks.size();
        if (feature->m_nodes[2] >= 0) m_faceBlocks = m_blocks.size();
    }
    m_rowsOf.assign(m_blocks.size(), BlockRows());
    m_holds.assign(m_blocks.size(), 0);
}

void ContactGroup::addFeature(const RoundsNodes& nodes, const FeatureContacts& feature)
{
    int moved[3], count = 0;
    for (int k = 0; k < 3; ++k)
    {
        const int node = feature.m_nodes[k] >= 0 ? feature.m_nodes[k] : feature.m_nodes[0];
        moved[k] = nodes.m_movedOfNode[static_cast<std::size_t>(node)];
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
        {
            fillLane(nodes, block, lane, block.m_contacts[std::min(lane, block.m_lanes - 1)]);
            if (lane >= block.m_lanes) block.m_level[lane] = -std::numeric_limits<float>::infinity();
        }
    }
}

void ContactGroup::fillLane(const RoundsNodes& nodes, Block& block, int lane, const Contact& contact)
{
    block.m_weights[0][lane] = contact.m_weights[1];
    block.m_weights[1][lane] = contact.m_weights[2];
    float level = static_cast<float>(nodes.m_contacts->m_mostThickness);
    for (int axis = 0; axis < 3; ++axis)
    {
        block.m_normal[axis][lane] = contact.m_normal[axis];
        level += contact.m_normal[axis] * contact.m_point[axis];
    }
    block.m_level[lane] = level + nodes.m_margin;
}

ContactGroup::Row ContactGroup::makeRow(const RoundsNodes& nodes, const Block& block, int lane)
{
    const StepContact contact =
        nodes.m_found->resolve(*nodes.m_body, nodes.m_contacts->m_limit.paths(), block.m_contacts[lane]);
    Row row = Row();
    row.m_count = block.m_count;
    std::copy(block.m_moved, block.m_moved + 3, row.m_moved);
    row.m_held.setZero();
    row.m_friction = contact.m_friction;
    row.m_distance = contact.m_thickness + contact.m_targetGap;
    row.m_carry = contact.m_carry;
    row.m_carriedStarts = contact.m_carriedStarts;
    setPlane(nodes, row, contact.m_weights, contact.m_normal, contact.m_point);
    row.m_speedLimit = SIMD_INFINITY;
    if (contact.m_startGap < 0)
    {
        const btScalar recovered = std::max(btScalar(0), contact.m_endGap - contact.m_startGap);
        row.m_speedLimit = (recovered + row.m_normal.dot(carriedFrom(nodes, row))) * nodes.m_body->m_sst.isdt;
    }
    return row;
}

// Returns the position of the row's point of the cloth at the step's start.
btVector3 ContactGroup::startOf(const RoundsNodes& nodes, const Row& row)
{
    const std::vector<btVector3>& starts = nodes.m_contacts->m_limit.paths().m_start;
    btVector3 start(0, 0, 0);
    for (int k = 0; k < row.m_count; ++k)
    {
        const int node = nodes.m_moved[static_cast<std::size_t>(row.m_moved[k])].m_node;
        start += starts[static_cast<std::size_t>(node)] * row.m_weights[k];
    }
    return start;
}

// Returns how far the obstacle's motion in the step moves the row's point, m.
btVector3 ContactGroup::carriedFrom(const RoundsNodes& nodes, const Row& row)
{
    if (!row.m_carriedStarts) return row.m_carry ? *row.m_carry * row.m_start - row.m_start : btVector3(0, 0, 0);
    btVector3 carried = -row.m_start;
    for (int k = 0; k < row.m_count; ++k)
        carried +=
            row.m_carriedStarts[nodes.m_moved[static_cast<std::size_t>(row.m_moved[k])].m_node] * row.m_weights[k];
    return carried;
}

void ContactGroup::setPlane(const RoundsNodes& nodes, Row& row, const btScalar weights[3], const btVector3& normal,
                            const btVector3& point)
{
    btScalar mobility = 0, held = 0, most = 0;
    for (int k = 0; k < row.m_count; ++k)
    {
        const btScalar inverseMass = nodes.m_moved[static_cast<std::size_t>(row.m_moved[k])].m_inverseMass;
        row.m_weights[k] = weights[k];
        row.m_shares[k] = weights[k] * inverseMass;
        mobility += weights[k] * weights[k] * inverseMass;
        most = std::max(most, inverseMass);
        if (!(inverseMass > 0)) held += weights[k];
    }
    const btScalar softened = mobility + kHeldSoftness * held * most;
    row.m_inverseMobility = mobility > 0 ? 1 / softened : btScalar(0);
    row.m_mended = held > 0 ? mobility * row.m_inverseMobility : btScalar(1);
    row.m_normal = normal;
    row.m_start = startOf(nodes, row);
    const btVector3 carried = carriedFrom(nodes, row);
    row.m_carried = carried - normal * normal.dot(carried);
    row.m_level = normal.dot(point - row.m_start) + row.m_distance;
}

btScalar ContactGroup::violation(const RoundsNodes& nodes, const Row& row)
{
    btVector3 way = -row.m_start;
    for (int k = 0; k < row.m_count; ++k)
        way += nodes.m_places[static_cast<std::size_t>(row.m_moved[k])] * row.m_weights[k];
    return row.m_level - row.m_normal.dot(way);
}

// Renews the contact's plane where its features are nearest now; the block gets the same plane.
void ContactGroup::renewPlane(const RoundsNodes& nodes, Row& row, Block& block, int lane)
{
    float places[3][3];
    for (int k = 0; k < row.m_count; ++k)
        for (int axis = 0; axis < 3; ++axis)
            places[k][axis] = static_cast<float>(nodes.m_places[static_cast<std::size_t>(row.m_moved[k])][axis]);
    if (row.m_count == 2) std::copy(places[1], places[1] + 3, places[2]);  // a link
    ContactPlane plane;
    if (!FoundContacts::planeAt(block.m_contacts[lane], places, plane)) return;
    row.m_renewed = true;
    if (row.m_count == 2) joinCorners(plane.m_weights);
    const btScalar weights[3] = {plane.m_weights[0], plane.m_weights[1], plane.m_weights[2]};
    const btVector3 point(plane.m_point[0], plane.m_point[1], plane.m_point[2]);
    setPlane(nodes, row, weights, btVector3(plane.m_normal[0], plane.m_normal[1], plane.m_normal[2]), point);
    for (int axis = 0; axis < 3; ++axis)
        block.m_normal[axis][lane] = plane.m_normal[axis];
    block.m_weights[0][lane] = plane.m_weights[1];
    block.m_weights[1][lane] = plane.m_weights[2];
    block.m_level[lane] = static_cast<float>(row.m_normal.dot(point) + row.m_distance) + nodes.m_margin;
}

// Returns whether the contact had anything to do; `worst` grows to its violation.
bool ContactGroup::project(RoundsNodes& nodes, Row& row, btScalar& worst)
{
    if (row.m_count == 1) return projectNodes<1>(nodes, row, worst);
    return row.m_count == 2 ? projectNodes<2>(nodes, row, worst) : projectNodes<3>(nodes, row, worst);
}

template <int count>
bool ContactGroup::projectNodes(RoundsNodes& nodes, Row& row, btScalar& worst)
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
        places[k] = &nodes.m_places[static_cast<std::size_t>(row.m_moved[k])];
        load(*places[k], x[k]);
        way += x[k] * row.m_weights[k];
    }
    const btScalar along = dot(normal, way), violation = row.m_level - along;
    if (!(violation > 0) && !(row.m_multiplier > 0)) return false;  // also for NaN
    worst = std::max(worst, violation * row.m_mended);
    const btScalar pushed = std::max(btScalar(0), row.m_multiplier + violation * row.m_inverseMobility);
    // Friction removes the point's motion along the surface, within the cone. A push does not change that motion.
    Quad hold = held - (way - normal * along - carried) * row.m_inverseMobility;
    const btScalar most = row.m_friction * pushed;
    const btScalar wanted2 = dot(hold, hold);
    if (wanted2 > most * most) hold *= most / btSqrt(wanted2);
    const Quad shift = normal * (pushed - row.m_multiplier) + (hold - held);
    for (int k = 0; k < count; ++k)
    {
        const std::size_t moved = static_cast<std::size_t>(row.m_moved[k]);
        store(x[k] + shift * row.m_shares[k], *places[k]);
        nodes.m_shifted[moved] = 1;
    }
    row.m_multiplier = pushed;
    store(hold, row.m_held);
    row.m_pushed = true;
    return true;
}

// Returns an upper bound of each lane's violation, m.
inline Lanes ContactGroup::excessOf(const Block& block, const btVector3* places)
{
    if (block.m_count == 1) return excessOfNodes<1>(block, places);
    return block.m_count == 2 ? excessOfNodes<2>(block, places) : excessOfNodes<3>(block, places);
}

template <int count>
inline Lanes ContactGroup::excessOfNodes(const Block& block, const btVector3* places)
{
    const Lanes a = lanesOf(places[block.m_moved[0]]);
    Lanes at[3];
    for (int axis = 0; axis < 3; ++axis)
        at[axis] = Lanes{a[axis], a[axis], a[axis], a[axis]};
    for (int k = 1; k < count; ++k)
    {
        const Lanes way = lanesOf(places[block.m_moved[k]]) - a;
        for (int axis = 0; axis < 3; ++axis)
            at[axis] += block.m_weights[k - 1] * way[axis];
    }
    return block.m_level - (block.m_normal[0] * at[0] + block.m_normal[1] * at[1] + block.m_normal[2] * at[2]);
}

// Projects the due contacts of a block in order: those that push and those that may be violated. Returns the worst
// violation, or 0.
btScalar ContactGroup::projectBlock(RoundsNodes& nodes, std::size_t index, unsigned due)
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
            m_rows.push_back(makeRow(nodes, block, lane));
        }
        Row& row = m_rows[static_cast<std::size_t>(at)];
        if (!(row.m_inverseMobility > 0)) continue;
        if (row.m_stage != m_stage && isViolated(nodes, row))
        {
            renewPlane(nodes, row, block, lane);
            row.m_stage = m_stage;
        }
        if (!(row.m_inverseMobility > 0) || !project(nodes, row, worst)) continue;
        holds |= 1u << lane;
        if (lane + 1 < block.m_lanes) due |= bitsAbove0(excessOf(block, nodes.m_places.data()));  // its nodes moved
    }
    m_holds[index] = static_cast<unsigned char>(holds);
    if (held == 0 && holds != 0) m_holding.push_back(index);
    return worst;
}

void ContactGroup::beginStage(unsigned stage)
{
    if (m_stage == stage) return;
    m_stage = stage;
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

btScalar ContactGroup::look(RoundsNodes& nodes, unsigned stage, Kinds kinds)
{
    beginStage(stage);
    const std::size_t first = kinds == Kinds::Edges ? m_faceBlocks : 0;
    const std::size_t last = kinds == Kinds::Nodes           ? m_nodeBlocks
                             : kinds == Kinds::NodesAndFaces ? m_faceBlocks
                                                             : m_blocks.size();
    const Block* const blocks = m_blocks.data();
    const btVector3* const places = nodes.m_places.data();
    const unsigned char* const holds = m_holds.data();
    btScalar worst = 0;
    for (std::size_t i = first; i < last; ++i)
    {
        const Lanes excess = excessOf(blocks[i], places);
        if (holds[i] != 0 || anyAbove0(excess))
            worst = std::max(worst, projectBlock(nodes, i, bitsAbove0(excess) | holds[i]));
    }
    return worst;
}

bool ContactGroup::listSettling()
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
    return !m_settling.empty();
}

void ContactGroup::settle(RoundsNodes& nodes)
{
    btScalar worst = 0;
    for (Row* row : m_settling)
        project(nodes, *row, worst);
}

void ContactGroup::limitSpeed(const RoundsNodes& nodes, const Row& row)
{
    btScalar speed = 0;
    for (int k = 0; k < row.m_count; ++k)
        speed += nodes.m_body->m_nodes[nodes.m_moved[static_cast<std::size_t>(row.m_moved[k])].m_node].m_v.dot(
                     row.m_normal) *
                 row.m_weights[k];
    const btScalar excess = speed - row.m_speedLimit;
    if (!(excess > 0) || !(row.m_inverseMobility > 0)) return;  // a renewed plane may rest on pinned nodes alone
    for (int k = 0; k < row.m_count; ++k)
    {
        const RoundsNodes::Moved& moved = nodes.m_moved[static_cast<std::size_t>(row.m_moved[k])];
        nodes.m_body->m_nodes[moved.m_node].m_v -= row.m_normal * (row.m_shares[k] * excess * row.m_inverseMobility);
    }
}

void ContactGroup::limitSpeeds(const RoundsNodes& nodes) const
{
    for (const BlockRows& rows : m_rowsOf)
        for (const int row : rows.m_row)
            if (row >= 0 && m_rows[static_cast<std::size_t>(row)].m_pushed)
                limitSpeed(nodes, m_rows[static_cast<std::size_t>(row)]);
}

bool ContactGroup::mayHavePassed(const RoundsNodes& nodes) const
{
    const btScalar least = kNearShare * nodes.m_contacts->m_leastThickness;
    return std::any_of(m_rows.begin(), m_rows.end(),
                       [&](const Row& row) { return row.m_pushed && row.m_distance - violation(nodes, row) < least; });
}
}  // namespace drape
