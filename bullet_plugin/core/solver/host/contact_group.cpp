#include "contact_group.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "kernels/lib/solver/acting_contact.h"

namespace drape
{
namespace
{
template <class Lanes>
std::uint64_t bothHalves(const Lanes& bits)
{
    std::uint64_t halves[2];
    std::memcpy(halves, &bits, sizeof(bits));
    return halves[0] | halves[1];
}

template <class Lanes>
bool anyAbove0(const Lanes& values)
{
    return bothHalves(values > 0) != 0;
}

// Returns a bit for each lane that is above 0.
template <class Lanes>
unsigned bitsAbove0(const Lanes& values)
{
    using Bits = DRAPE_VECTOR_OF(int, 4);
    const std::uint64_t both = bothHalves((values > 0) & Bits{1, 2, 4, 8});
    return unsigned(both | both >> 32);
}
}  // namespace

void ContactGroup::clear()
{
    m_features.clear();
    m_blocks.clear();
    m_nodeBlocks = m_faceBlocks = 0;
    m_rows.clear();
    m_pushingBlocks.clear();
}

void ContactGroup::makeBlocks(const SweptCloth& cloth)
{
    const auto isBefore = [](const FeatureContacts* a, const FeatureContacts* b)
    {
        const OrderedFeature &first = *a->m_feature, &second = *b->m_feature;
        return first.m_kind != second.m_kind ? first.m_kind < second.m_kind : first.m_colour < second.m_colour;
    };
    std::stable_sort(m_features.begin(), m_features.end(), isBefore);
    for (const FeatureContacts* feature : m_features)
    {
        addFeature(cloth, *feature);
        if (feature->m_feature->m_kind == kNodeFeature) m_nodeBlocks = m_blocks.size();
        if (feature->m_feature->m_kind != kEdgeFeature) m_faceBlocks = m_blocks.size();
    }
    m_rowsOf.assign(m_blocks.size(), BlockRows());
    m_pushing.assign(m_blocks.size(), 0);
}

void ContactGroup::addFeature(const SweptCloth& cloth, const FeatureContacts& feature)
{
    for (std::uint32_t first = 0; first < feature.m_count; first += kLanes)
    {
        m_blocks.emplace_back();
        Block& block = m_blocks.back();
        block.m_contacts = feature.m_contacts + first;
        block.m_lanes = int(std::min(feature.m_count - first, std::uint32_t(kLanes)));
        block.m_count = 0;
        for (int k = 0; k < 3; ++k)
        {
            block.m_nodes[k] = feature.nodes()[k] >= 0 ? feature.nodes()[k] : feature.nodes()[0];
            block.m_count += feature.nodes()[k] >= 0 ? 1 : 0;
        }
        for (int lane = 0; lane < kLanes; ++lane)
        {
            fillLane(cloth, block, lane, block.m_contacts[std::min(lane, block.m_lanes - 1)]);
            if (lane >= block.m_lanes) block.m_level[lane] = -std::numeric_limits<float>::infinity();
        }
    }
}

void ContactGroup::fillLane(const SweptCloth& cloth, Block& block, int lane, const Contact& contact)
{
    const SolverNodes& nodes = cloth.nodes();
    block.m_weights[0][lane] = contact.m_weights[1];
    block.m_weights[1][lane] = contact.m_weights[2];
    const Vec3 first = nodes.start(std::size_t(block.m_nodes[0]));
    Vec3 start = first;
    for (int k = 1; k < block.m_count; ++k)
        start = vec3AddScaled(start, vec3Sub(nodes.start(std::size_t(block.m_nodes[k])), first), contact.m_weights[k]);
    const float apart[3] = {contact.m_point[0] - start.x, contact.m_point[1] - start.y, contact.m_point[2] - start.z};
    float level = cloth.m_contacts->m_mostThickness;
    for (int axis = 0; axis < 3; ++axis)
    {
        block.m_normal[axis][lane] = contact.m_normal[axis];
        level += contact.m_normal[axis] * apart[axis];
    }
    block.m_level[lane] = level + cloth.m_margin;
}

ContactGroup::Row ContactGroup::makeRow(const SweptCloth& cloth, const Block& block, int lane)
{
    const ClothContacts& contacts = *cloth.m_contacts;
    const SolverContact contact = contacts.resolve(*cloth.m_source, block.m_contacts[lane]);
    const FeatureNodes nodes = featureNodes(cloth.nodes(), contact.m_nodes, contact.m_carry);
    const ContactSettings settings = {contact.m_thickness, contact.m_friction, contacts.m_hardness,
                                      contacts.m_perSecond};
    return {actingContact(&nodes, &contact.m_plane, &settings, contact.m_gaps), contact.m_carry, vec3(0, 0, 0)};
}

// Turns a contact of a face with a vertex to where the two are nearest now; see drape::renewPlane().
bool ContactGroup::turn(const SweptCloth& cloth, const Block& block, int lane, float passed, Row& row,
                        ContactPlane& plane)
{
    const Contact& found = block.m_contacts[lane];
    const int indices[3] = {block.m_nodes[0], block.m_nodes[1], block.m_count < 3 ? -1 : block.m_nodes[2]};
    const FeatureNodes nodes = featureNodes(cloth.nodes(), indices, row.m_carry);
    Vec3 displacements[3] = {};
    for (std::uint32_t k = 0; k < nodes.m_count; ++k)
        displacements[k] = cloth.nodes().displacement(nodes.m_nodes[k]);
    const ContactPlane before = {vec3Load(found.m_normal, 0), vec3Load(found.m_point, 0), {}};
    return renewPlane(&row.m_acting, &nodes, displacements, passed, &before, &plane) != 0;
}

// Renews the contact's plane where its features are nearest now; the block gets the same plane. Only faces at a vertex
// turn their contacts, and a contact that was met keeps its plane.
void ContactGroup::renew(const SweptCloth& cloth, Row& row, Block& block, int lane)
{
    ContactPlane plane;
    if (!contactTurns(&block.m_contacts[lane]) || !turn(cloth, block, lane, cloth.m_passed, row, plane)) return;
    block.m_normal[0][lane] = plane.m_normal.x;
    block.m_normal[1][lane] = plane.m_normal.y;
    block.m_normal[2][lane] = plane.m_normal.z;
    block.m_weights[0][lane] = plane.m_weights[1];
    block.m_weights[1][lane] = plane.m_weights[2];
    block.m_level[lane] = row.m_acting.m_row.m_level + cloth.m_margin;
}

// Returns whether the contact had anything to do; `worst` grows to its violation.
bool ContactGroup::project(const SweptCloth& cloth, ActingContact& acting, float& worst)
{
    SolverNodes& nodes = cloth.nodes();
    ContactRow& row = acting.m_row;
    const float relaxation = cloth.m_actingSweeps > 0 ? DRAPE_TURN_RELAXATION : 1.0f;
    if (!projectRow(&row, nodes.nodes(), cloth.m_passed, cloth.m_tolerated, relaxation, &worst)) return false;
    for (std::uint32_t k = 0; k < row.m_count; ++k)
        nodes.markPushed(row.m_nodes[k]);
    acting.m_pushed = 1;
    return true;
}

// Returns an upper bound of each lane's violation, m.
inline ContactGroup::Lanes ContactGroup::excessOf(const Block& block, const SolverNode* nodes, float slack)
{
    if (block.m_count == 1) return excessOfNodes<1>(block, nodes, slack);
    return block.m_count == 2 ? excessOfNodes<2>(block, nodes, slack) : excessOfNodes<3>(block, nodes, slack);
}

template <int count>
inline ContactGroup::Lanes ContactGroup::excessOfNodes(const Block& block, const SolverNode* nodes, float slack)
{
    const Vec3 a = nodes[block.m_nodes[0]].m_displacement;
    Lanes at[3] = {Lanes{a.x, a.x, a.x, a.x}, Lanes{a.y, a.y, a.y, a.y}, Lanes{a.z, a.z, a.z, a.z}};
    for (int k = 1; k < count; ++k)
    {
        const Vec3 offset = vec3Sub(nodes[block.m_nodes[k]].m_displacement, a);
        at[0] += block.m_weights[k - 1] * offset.x;
        at[1] += block.m_weights[k - 1] * offset.y;
        at[2] += block.m_weights[k - 1] * offset.z;
    }
    return block.m_level + slack - (block.m_normal[0] * at[0] + block.m_normal[1] * at[1] + block.m_normal[2] * at[2]);
}

// Projects the due contacts of a block in order: those that push and those that may be violated. Returns the worst
// violation, or 0.
float ContactGroup::projectBlock(const SweptCloth& cloth, std::size_t index, unsigned due)
{
    const SolverNode* const nodes = cloth.nodes().nodes();
    Block& block = m_blocks[index];
    const unsigned before = m_pushing[index];
    const float slack = cloth.slack();
    unsigned pushing = before;
    float worst = 0;
    for (int lane = 0; lane < kLanes; ++lane)
    {
        if (!(due >> lane & 1u)) continue;
        int& at = m_rowsOf[index].m_row[lane];
        if (at < 0)
        {
            at = int(m_rows.size());
            m_rows.push_back(makeRow(cloth, block, lane));
        }
        ActingContact& acting = m_rows[std::size_t(at)].m_acting;
        if (!(acting.m_row.m_inverseMobility > 0)) continue;
        if (acting.m_phase != m_phase && rowViolation(&acting.m_row, nodes, cloth.m_passed) > 0)
        {
            renew(cloth, m_rows[std::size_t(at)], block, lane);
            acting.m_phase = m_phase;
        }
        if (!(acting.m_row.m_inverseMobility > 0) || !project(cloth, acting, worst)) continue;
        pushing |= 1u << lane;
        if (lane + 1 < block.m_lanes) due |= bitsAbove0(excessOf(block, nodes, slack));  // its nodes moved
    }
    m_pushing[index] = static_cast<unsigned char>(pushing);
    if (before == 0 && pushing != 0) m_pushingBlocks.push_back(index);
    return worst;
}

// Adds what the phase's pushes give to the impulses of their rows. Once in a phase, at its end.
void ContactGroup::addImpulses()
{
    for (const std::size_t index : m_pushingBlocks)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            if (!(m_pushing[index] >> lane & 1)) continue;
            Row& row = m_rows[std::size_t(m_rowsOf[index].m_row[lane])];
            row.m_impulse = vec3AddScaled(row.m_impulse, rowPush(&row.m_acting.m_row), m_perPush);
        }
}

void ContactGroup::beginPhase(const SweptCloth& cloth)
{
    if (m_phase == cloth.m_phase) return;
    if (cloth.m_records) addImpulses();
    m_phase = cloth.m_phase;
    m_perPush = cloth.m_perPush;
    for (const std::size_t index : m_pushingBlocks)
    {
        for (int lane = 0; lane < kLanes; ++lane)
        {
            if (!(m_pushing[index] >> lane & 1)) continue;
            ContactRow& row = m_rows[std::size_t(m_rowsOf[index].m_row[lane])].m_acting.m_row;
            row.m_multiplier = 0;
            row.m_held = vec3(0, 0, 0);
        }
        m_pushing[index] = 0;
    }
    m_pushingBlocks.clear();
}

std::pair<std::size_t, std::size_t> ContactGroup::rangeOf(Kinds kinds) const
{
    if (kinds == Kinds::Edges) return {m_faceBlocks, m_blocks.size()};
    return {0, kinds == Kinds::Nodes ? m_nodeBlocks : m_faceBlocks};
}

float ContactGroup::sweep(const SweptCloth& cloth, Kinds kinds)
{
    beginPhase(cloth);
    const auto [first, last] = rangeOf(kinds);
    const Block* const blocks = m_blocks.data();
    const SolverNode* const nodes = cloth.nodes().nodes();
    const unsigned char* const pushing = m_pushing.data();
    const float slack = cloth.slack();
    float worst = 0;
    for (std::size_t i = first; i < last; ++i)
    {
        const Lanes excess = excessOf(blocks[i], nodes, slack);
        if (pushing[i] != 0 || anyAbove0(excess))
            worst = std::max(worst, projectBlock(cloth, i, bitsAbove0(excess) | pushing[i]));
    }
    return worst;
}

void ContactGroup::sweepActing(const SweptCloth& cloth)
{
    std::sort(m_pushingBlocks.begin(), m_pushingBlocks.end());
    float worst = 0;
    for (int i = 0; i < cloth.m_actingSweeps; ++i)
        for (const std::size_t index : m_pushingBlocks)
            for (unsigned lane = 0, pushing = m_pushing[index]; pushing != 0; ++lane, pushing >>= 1)
                if (pushing & 1u) project(cloth, m_rows[std::size_t(m_rowsOf[index].m_row[lane])].m_acting, worst);
}

void ContactGroup::limitSpeeds(const SweptCloth& cloth, Kinds kinds)
{
    const auto [first, last] = rangeOf(kinds);
    for (std::size_t i = first; i < last; ++i)
        for (const int index : m_rowsOf[i].m_row)
        {
            if (index < 0 || !m_rows[std::size_t(index)].m_acting.m_pushed) continue;
            Row& row = m_rows[std::size_t(index)];
            const float taken = limitSpeed(&row.m_acting, cloth.nodes().states());
            row.m_impulse = vec3AddScaled(row.m_impulse, row.m_acting.m_row.m_normal, -taken);
        }
}

bool ContactGroup::hasPushed() const
{
    return std::any_of(m_rows.begin(), m_rows.end(), [](const Row& row) { return row.m_acting.m_pushed != 0; });
}

// Returns whether a contact ends with less than `least` between its features' points, m. It may have turned to where
// nodes were on the way, away from where they end.
bool ContactGroup::endsNear(const SweptCloth& cloth, const Block& block, int lane, const Row& row, float least)
{
    const auto isNear = [&](const ActingContact& acting)
    { return acting.m_distance - rowViolation(&acting.m_row, cloth.nodes().nodes(), 1) < least; };
    if (isNear(row.m_acting)) return true;
    if (!contactTurns(&block.m_contacts[lane]) || row.m_acting.m_phase == 0) return false;
    Row now = row;
    ContactPlane plane;
    return !turn(cloth, block, lane, 1, now, plane) || isNear(now.m_acting);
}

bool ContactGroup::mayHavePassed(const SweptCloth& cloth) const
{
    const float least = kNearShare * cloth.m_contacts->m_leastThickness;
    for (std::size_t i = 0; i < m_blocks.size(); ++i)
    {
        for (int lane = 0; lane < kLanes; ++lane)
        {
            const int row = m_rowsOf[i].m_row[lane];
            if (row >= 0 && endsNear(cloth, m_blocks[i], lane, m_rows[std::size_t(row)], least)) return true;
        }
    }
    return false;
}
}  // namespace drape
