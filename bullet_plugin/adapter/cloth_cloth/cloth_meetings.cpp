#include "bullet_plugin/adapter/cloth_cloth/cloth_meetings.h"

#include <algorithm>

#include "bullet_plugin/adapter/cloth_cloth/soft_body_filters.h"
#include "bullet_plugin/adapter/cloth_cloth/state_hash.h"
#include "bullet_plugin/adapter/mirrors/solid_links.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/core/backends/device_cloth_search.h"
#include "bullet_plugin/core/solver/topology/cloth_faces.h"
#include "bullet_plugin/core/threads/ranges.h"

namespace drape
{
namespace
{
// Greatest way in a step of a node whose triangles intersect others, and in a second, as shares of the thickness.
constexpr float kPushedShare = 0.2f, kPushedPerSecond = 12;

// Minimum contacts for sharing them among threads, and those of a range.
constexpr std::size_t kLeastShared = 2048, kRange = 512;

// Maximum times that the guard is applied to let nodes that stopped each other go on together.
constexpr int kMostTurns = 8;
// Turns after which they move as one.
constexpr int kTurnsWithShares = 2;

btVector3 vectorOf(const double v[3])
{
    return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
}

// Returns whether the body is anchored to something that does not yield.
bool hangs(const btSoftBody& body)
{
    for (int i = 0; i < body.m_anchors.size(); ++i)
        if (body.m_anchors[i].m_body->isStaticOrKinematicObject()) return true;
    return false;
}

// Gives a node at least the speed at which it was pushed in the step, along the push, so that its neighbours follow.
// way: m.
void follow(const btSoftBody& body, btSoftBody::Node& node, const btVector3& way)
{
    const btScalar length = way.length();
    const btScalar lacking = length * body.m_sst.isdt - node.m_v.dot(way) / length;
    if (length > 0 && lacking > 0) node.m_v += way * (lacking / length);
}

// Lists the body's triangles whose nodes are all its own, and the links that are solid.
void readFaces(const btSoftBody& body, std::vector<std::int32_t>& triangles, std::vector<std::int32_t>& edges)
{
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        std::int32_t nodes[3];
        for (int k = 0; k < 3; ++k)
            nodes[k] = nodeIndex(body, body.m_faces[f].m_n[k]);
        if (std::count(nodes, nodes + 3, kForeign) == 0) triangles.insert(triangles.end(), nodes, nodes + 3);
    }
    SolidLinks links;
    links.read(body, triangles);
    edges.assign(links.nodes().begin(), links.nodes().end());
}
}  // namespace

// Returns a number that changes with the members, their thickness, and their faces.
std::uint64_t ClothMeetings::layoutHash() const
{
    StateHash hash;
    for (const Member& member : m_members)
    {
        const btSoftBody& body = *member.m_body;
        hash.add(&body).add(std::uint64_t(member.m_thickness * 1e7));
        hash.add(std::uint64_t(body.m_nodes.size())).add(std::uint64_t(body.m_links.size()));
        hash.add(std::uint64_t(member.m_self->m_revision));
        for (int f = 0; f < body.m_faces.size(); ++f)
            for (int k = 0; k < 3; ++k)
                hash.add(std::uint64_t(body.m_faces[f].m_n[k] - &body.m_nodes[0]));
    }
    return hash.value();
}

void ClothMeetings::assignSet()
{
    std::vector<std::vector<std::int32_t>> triangles(m_members.size()), edges(m_members.size());
    std::vector<SetMember> members;
    for (std::size_t i = 0; i < m_members.size(); ++i)
    {
        const btSoftBody& body = *m_members[i].m_body;
        readFaces(body, triangles[i], edges[i]);
        members.push_back({triangles[i].data(), triangles[i].size() / 3, edges[i].data(), edges[i].size() / 2,
                           m_members[i].m_self->m_rest.data(), static_cast<std::size_t>(body.m_nodes.size()),
                           float(m_members[i].m_thickness)});
    }
    m_set.assign(members, m_state.threads());
}

void ClothMeetings::begin(const Bodies& bodies, const std::function<bool(const btSoftBody&)>& isStepped)
{
    m_members.clear();
    m_state.m_clothPairs.clear();
    ++m_step;
    bool anyStepped = false;
    for (int i = 0; i < bodies.size(); ++i)
    {
        SelfColliding* const self = m_state.m_selfCollision.find(*bodies[i]);
        if (!self || bodies[i]->m_nodes.size() == 0) continue;
        const bool moves = isStepped(*bodies[i]);
        anyStepped = anyStepped || moves;
        m_members.push_back({bodies[i], self, SelfCollision::thicknessOf(*bodies[i], *self), moves, nullptr, false});
    }
    if (!anyStepped) m_members.clear();
    m_wasPushed = false;
    // Without cloth that meets cloth, the device's memory goes back.
    m_set.useDevice(m_members.empty() ? SearchDevice() : m_state.pipeline().searchDevice());
    if (m_members.empty()) return;
    const std::uint64_t layout = layoutHash();
    if (layout != m_layout || m_set.memberCount() != m_members.size())
    {
        assignSet();
        m_rows.clear(false);
        m_isClean = false;
    }
    m_layout = layout;
    m_answers.clear(m_members.size());
    noteFilters();
}

// Notices bodies that may meet others than in the last step.
void ClothMeetings::noteFilters()
{
    for (const Member& member : m_members)
    {
        StateHash hash;
        hash.add(filterHash(*member.m_body));
        hash.add(std::uint64_t(member.m_self->m_meetsItself) << 1 | std::uint64_t(member.m_self->m_meetsOthers));
        m_isClean = m_isClean && hash.value() == member.m_self->m_filters;
        member.m_self->m_filters = hash.value();
    }
    StateHash answers;
    for (std::size_t i = 0; i < m_members.size() && hasOwnFilter(*m_members[i].m_body); ++i)
        for (std::size_t k = 0; k < i; ++k)
            answers.add(std::uint64_t(canMeet(i, k)));
    m_isClean = m_isClean && answers.value() == m_answersHash;
    m_answersHash = answers.value();
}

// Returns whether two members collide. Asks once in a step.
bool ClothMeetings::canMeet(std::size_t a, std::size_t b) const
{
    if (!m_answers.isKnown(a, b)) m_answers.set(a, b, mayMeet(a, b));
    return m_answers.isYes(a, b);
}

// Returns whether two members collide: as they ask for it, and as Bullet's filters let them.
bool ClothMeetings::mayMeet(std::size_t a, std::size_t b) const
{
    if (a == b) return m_members[a].m_self->m_meetsItself;
    if (!m_members[a].m_self->m_meetsOthers || !m_members[b].m_self->m_meetsOthers) return false;
    return filtersLetMeet(*m_members[a].m_body, *m_members[b].m_body);
}

btVector3 ClothMeetings::startOf(std::size_t node) const
{
    return vectorOf(vec3Load(m_set.start(), std::uint32_t(node)));
}

// Calls write(member, node of Bullet's, node of the set) for all nodes.
template <class Write>
void ClothMeetings::forNodes(const Write& write)
{
    for (std::size_t i = 0; i < m_members.size(); ++i)
        for (int k = 0; k < m_members[i].m_body->m_nodes.size(); ++k)
            write(m_members[i], m_members[i].m_body->m_nodes[k], m_set.firstNode(i) + std::size_t(k));
}

// Asks once for each two members of the contacts whether they may meet: filters may be the app's.
void ClothMeetings::askContacts()
{
    const std::size_t count = m_members.size();
    const auto mark = [&](std::size_t first, std::size_t last)
    {
        for (std::size_t i = first; i < last; ++i)
        {
            const SelfContactView view = m_set.view(m_contacts[i]);
            const std::size_t a = m_set.memberOf(std::size_t(view.m_nodes[0]));
            const std::size_t b = m_set.memberOf(std::size_t(view.m_nodes[3]));
            m_answers.mark(a, b);
        }
    };
    forRanges(m_contacts.size(), kLeastShared, kRange, &m_state.threads(), mark);
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b)
            if (m_answers.isMarked(a, b)) canMeet(a, b);
}

// Writes the row of a contact. Returns whether it has one. After askContacts(), on any thread.
bool ClothMeetings::takeRow(std::size_t index, ClothContact& contact)
{
    const SelfContactView view = m_set.view(m_contacts[index]);
    const int split = view.m_kind == DRAPE_SELF_EDGE_EDGE ? 2 : 1;
    const std::size_t first = m_set.memberOf(std::size_t(view.m_nodes[0]));
    const std::size_t second = m_set.memberOf(std::size_t(view.m_nodes[3]));
    const std::uint32_t nodes[4] = {std::uint32_t(view.m_nodes[0]), std::uint32_t(view.m_nodes[1]),
                                    std::uint32_t(view.m_nodes[2]), std::uint32_t(view.m_nodes[3])};
    if (!m_answers.isYes(first, second) || isTangled(nodes)) return false;
    contact.m_key = ContactRecords::keyOf(m_contacts[index]);
    contact.m_split = split;
    bool moves = false;
    for (int k = 0; k < 4; ++k)
    {
        const std::size_t member = k < split ? first : second;
        contact.m_cloths[k] = m_members[member].m_nodes;
        contact.m_nodes[k] = nodes[k] - std::uint32_t(m_set.firstNode(member));
        contact.m_ids[k] = nodes[k];
        contact.m_resting[k] = vec3Load(m_set.start(), nodes[k]);
        moves = moves || m_members[member].m_nodes;
    }
    if (!moves) return false;
    const btSoftBody &a = *m_members[first].m_body, &b = *m_members[second].m_body;
    contact.m_normal = vec3(view.m_normal[0], view.m_normal[1], view.m_normal[2]);
    contact.m_gap0 = view.m_gap0;
    contact.m_index = std::uint32_t(index);
    contact.m_thickness = std::min(view.m_thickness, m_set.thicknessOf(first, second));
    contact.m_friction = float(std::max(a.m_cfg.kDF, b.m_cfg.kDF));  // Bullet's between soft bodies
    m_answers.noteRow(first, second);
    return true;
}

// Returns whether a member starts the step where the last one left it, but for held nodes, which the app may have
// moved.
bool ClothMeetings::startsAtLastEnd(std::size_t member) const
{
    const std::size_t first = m_set.firstNode(member), count = m_set.firstNode(member + 1) - first;
    const SelfColliding& self = *m_members[member].m_self;
    const std::vector<float>& ends = self.m_ends;
    if (ends.size() != 3 * count || self.m_solver != this || self.m_step + 1 != m_step) return false;
    for (std::size_t i = 0; i < 3 * count; ++i)
        if (!m_isHeld[first + i / 3] && m_set.start()[3 * first + i] != ends[i]) return false;
    return true;
}

// Lets a member's held nodes come from where they were after the last step: the app has moved them since.
void ClothMeetings::startHeldNodes(std::size_t member)
{
    const std::size_t first = m_set.firstNode(member);
    const std::vector<float>& ends = m_members[member].m_self->m_ends;
    for (std::size_t i = 0; i < ends.size(); ++i)
        if (m_isHeld[first + i / 3]) m_set.start()[3 * first + i] = ends[i];
}

// Looks for triangles that intersect where the step starts, unless it starts where the last one left no such triangles.
void ClothMeetings::checkStarts()
{
    m_meeting.clear();
    for (std::size_t i = 0; i < m_members.size(); ++i)
    {
        if (startsAtLastEnd(i))
            startHeldNodes(i);
        else
            m_isClean = false;
    }
    if (!m_isClean) listMeeting();
    nameTangles();
    for (std::size_t i = 0; i < m_meeting.size(); i += 6)
        m_state.m_clothPairs.push_back(pairAt(i));
}

void ClothMeetings::nameTangles()
{
    m_tangles.clear(m_meeting.empty() ? 0 : m_set.nodeCount());
    for (std::size_t i = 0; i < m_meeting.size(); ++i)
        m_tangles.join(m_meeting[i - i % 6], m_meeting[i]);
    m_tangles.nameGroups();
}

// Lists the triangles that intersect, of bodies that may meet.
void ClothMeetings::listMeeting()
{
    m_set.findMeeting(m_state.threads(), m_meeting);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < m_meeting.size(); i += 6)
    {
        if (!canMeet(m_set.memberOf(m_meeting[i]), m_set.memberOf(m_meeting[i + 3]))) continue;
        std::copy_n(m_meeting.begin() + std::ptrdiff_t(i), 6, m_meeting.begin() + std::ptrdiff_t(kept));
        kept += 6;
    }
    m_meeting.resize(kept);
}

// Returns two triangles that intersect, from the first of their nodes in the list.
ClothPairInfo ClothMeetings::pairAt(std::size_t first) const
{
    ClothPairInfo pair;
    for (std::size_t k = 0; k < 6; ++k)
    {
        const std::size_t node = m_meeting[first + k], member = m_set.memberOf(node);
        pair.m_bodies[k / 3] = m_members[member].m_body;
        pair.m_nodes[k / 3][k % 3] = int(node - m_set.firstNode(member));
    }
    return pair;
}

// Returns whether all nodes belong to one tangle: its features must pass each other to come apart.
bool ClothMeetings::isTangled(const std::uint32_t nodes[4]) const
{
    if (m_meeting.empty()) return false;
    const std::uint32_t tangle = m_tangles.groupOf(nodes[0]);
    return tangle != NodeGroups::kNone &&
           std::all_of(nodes, nodes + 4, [&](std::uint32_t node) { return m_tangles.groupOf(node) == tangle; });
}

bool ClothMeetings::isGuarded(const std::uint32_t nodes[4]) const
{
    return canMeet(m_set.memberOf(nodes[0]), m_set.memberOf(nodes[3])) && !isTangled(nodes);
}

ClothRows& ClothMeetings::find(const NodesOf& nodesOf)
{
    m_rows.clear(true);
    for (Member& member : m_members)
    {
        member.m_nodes = member.m_isStepped ? nodesOf(*member.m_body) : nullptr;
        member.m_hasRows = false;
    }
    const auto write = [&](const Member& member, const btSoftBody::Node& node, std::size_t index)
    {
        const std::size_t own = index - m_set.firstNode(std::size_t(&member - m_members.data()));
        float *start = m_set.start() + 3 * index, *end = m_set.end() + 3 * index;
        const btVector3& first = member.m_isStepped ? node.m_q : node.m_x;
        writePosition(member.m_nodes ? vectorOf(member.m_nodes->start(own)) : first, start);
        writePosition(member.m_nodes ? vectorOf(member.m_nodes->end(own)) : node.m_x, end);
        m_isHeld[index] = !member.m_isStepped || !(node.m_im > 0);
    };
    m_isHeld.resize(m_set.nodeCount());
    forNodes(write);
    checkStarts();
    const Settings& settings = m_state.settings();
    if (!m_set.findContacts(1 + settings.m_activation, settings.m_candidateLimit, settings.m_contactLimit,
                            m_state.threads(), m_contacts))
    {
        m_contacts.clear();
        m_state.m_statistics.m_status |= kStepClothsLeftOut;
    }
    askContacts();
    std::vector<Vec3> starts(m_contacts.empty() ? 0 : m_set.nodeCount());
    for (std::size_t node = 0; node < starts.size(); ++node)
        starts[node] = vec3Load(m_set.start(), std::uint32_t(node));
    m_rows.assign(
        m_contacts.size(), [this](std::size_t i, ClothContact& contact) { return takeRow(i, contact); }, starts);
    for (std::size_t i = 0; i < m_members.size(); ++i)
        m_members[i].m_hasRows = m_answers.hasRows(i);
    m_state.m_statistics.m_selfContacts += m_contacts.size();
    m_state.m_statistics.m_clothPairsSkipped += m_set.smoothPairs();
    return m_rows;
}

// Returns the feature of `count` of the contact's nodes, from `first` on.
ClothPoint ClothMeetings::pointOf(const SelfContactView& view, int first, int count) const
{
    const std::size_t member = m_set.memberOf(std::size_t(view.m_nodes[first]));
    const ContactFeature feature = count == 1   ? ContactFeature::AtNode
                                   : count == 2 ? ContactFeature::AtEdge
                                                : ContactFeature::AtFace;
    ClothPoint point = {m_members[member].m_body, feature, {-1, -1, -1}, {0, 0, 0}};
    for (int k = 0; k < count; ++k)
    {
        point.m_nodes[k] = int(std::size_t(view.m_nodes[first + k]) - m_set.firstNode(member));
        point.m_weights[k] = view.m_weights[first + k];
    }
    return point;
}

StepContact ClothMeetings::recordOf(const SelfContactView& view) const
{
    const int split = view.m_kind == DRAPE_SELF_EDGE_EDGE ? 2 : 1;
    const std::size_t first = m_set.memberOf(std::size_t(view.m_nodes[0]));
    const std::size_t second = m_set.memberOf(std::size_t(view.m_nodes[3]));
    StepContact contact = {};
    contact.m_cloth = pointOf(view, 0, split);
    contact.m_other = pointOf(view, split, 4 - split);
    contact.m_object = contact.m_other.m_body;
    contact.m_part = contact.m_triangle = -1;
    contact.m_objectFeature = contact.m_other.m_feature;
    std::copy_n(view.m_point, 3, contact.m_point);
    std::copy_n(view.m_normal, 3, contact.m_normal);
    contact.m_thickness = std::min(view.m_thickness, m_set.thicknessOf(first, second));
    contact.m_predictedGap = view.m_gap1 - contact.m_thickness;
    contact.m_timeOfImpact = view.m_time;
    return contact;
}

void ClothMeetings::record(ContactRecords& records) const
{
    std::vector<Vec3> impulses(m_contacts.size(), vec3(0, 0, 0));
    m_rows.forImpulses([&](std::uint32_t index, Vec3 impulse) { impulses[index] = impulse; });
    for (std::size_t i = 0; any() && i < m_contacts.size(); ++i)
    {
        const SelfContactView view = m_set.view(m_contacts[i]);
        const std::uint32_t nodes[4] = {std::uint32_t(view.m_nodes[0]), std::uint32_t(view.m_nodes[1]),
                                        std::uint32_t(view.m_nodes[2]), std::uint32_t(view.m_nodes[3])};
        if (isGuarded(nodes)) records.add(recordOf(view), impulses[i]);
    }
}

void ClothMeetings::addLayers(SupportedNodes& supported) const
{
    if (!any()) return;
    for (const Contact& found : m_contacts)
    {
        const SelfContactView view = m_set.view(found);
        LayerContact layer = {};
        layer.m_split = view.m_kind == DRAPE_SELF_EDGE_EDGE ? 2 : 1;
        std::uint32_t nodes[4];
        std::size_t members[4];
        for (int k = 0; k < 4; ++k)
        {
            nodes[k] = std::uint32_t(view.m_nodes[k]);
            members[k] = m_set.memberOf(nodes[k]);
            layer.m_cloths[k] = m_members[members[k]].m_nodes;
            layer.m_nodes[k] = nodes[k] - std::uint32_t(m_set.firstNode(members[k]));
            layer.m_weights[k] = view.m_weights[k];
        }
        const float thickness = std::min(view.m_thickness, m_set.thicknessOf(members[0], members[3]));
        const float gap = view.m_gap0 - thickness;
        if (gap > SupportedNodes::kNearBy * thickness || !isGuarded(nodes)) continue;
        layer.m_normal = vec3(view.m_normal[0], view.m_normal[1], view.m_normal[2]);
        layer.m_recover = gap < 0 ? targetGap(gap, 0, thickness) - gap : 0;
        supported.add(layer);
    }
}

bool ClothMeetings::hasRows(const SolverNodes& nodes) const
{
    return std::any_of(m_members.begin(), m_members.end(),
                       [&](const Member& member) { return member.m_nodes == &nodes && member.m_hasRows; });
}

// Returns the time that passes for a node of the set in the step, s.
btScalar ClothMeetings::timeOf(std::size_t node) const
{
    return m_members[m_set.memberOf(node)].m_body->m_sst.sdt;
}

// Moves the ends of triangles that started intersecting, once in a step. Their velocities stay.
void ClothMeetings::pushApart()
{
    std::vector<double> most(m_set.nodeCount(), double(kPushedShare * m_set.thickness()));
    for (std::size_t i = 0; i < m_meeting.size(); ++i)
    {
        const std::size_t pair = i - i % 6;
        const float thickness = m_set.thicknessOf(m_set.memberOf(m_meeting[pair]), m_set.memberOf(m_meeting[pair + 3]));
        const double share = std::min(double(kPushedShare), kPushedPerSecond * double(timeOf(m_meeting[i])));
        most[m_meeting[i]] = std::min(most[m_meeting[i]], share * thickness);
    }
    m_push.compute(m_wasPushed ? std::vector<std::uint32_t>() : m_meeting, m_set.start(), m_isHeld, most);
    m_wasPushed = true;
    for (std::size_t i = 0; i < m_push.displacements().size(); ++i)
        m_set.end()[i] += float(m_push.displacements()[i]);
}

bool ClothMeetings::isPushed(std::size_t node) const
{
    const std::vector<double>& all = m_push.displacements();
    return !all.empty() && (all[3 * node] != 0 || all[3 * node + 1] != 0 || all[3 * node + 2] != 0);
}

const std::vector<btSoftBody*>& ClothMeetings::guard(bool carries, const BodySet& fixed)
{
    m_moved.clear();
    readEnds();
    pushApart();
    const GuardResult result = applyGuard(carries, fixed);
    m_isClean = m_meeting.empty() && result.m_startMeeting == 0 && result.m_forced == 0 && !result.m_tooMany;
    StepStatistics& statistics = m_state.m_statistics;
    statistics.m_nodesShortened += result.m_shortened;
    statistics.m_clothPairsMeeting = m_meeting.size() / 6 + result.m_startMeeting + result.m_forced;
    if (statistics.m_clothPairsMeeting > 0) statistics.m_status |= kStepClothsMeet;
    listFlagged();
    if (result.m_tooMany) reportUnguarded();
    keepEnds();
    const auto read = [&](Member& member, btSoftBody::Node& node, std::size_t index)
    {
        if (!(m_guard.shares()[index] < 1) && !m_isShared[index] && !isPushed(index) && !m_guard.isCarried(index))
            return;
        node.m_x = vectorOf(vec3Load(m_set.end(), std::uint32_t(index)));
        if (isPushed(index)) follow(*member.m_body, node, vectorOf(m_push.displacements().data() + 3 * index));
        if (m_guard.isCarried(index)) follow(*member.m_body, node, node.m_x - startOf(index));
        if (m_moved.empty() || m_moved.back() != member.m_body) m_moved.push_back(member.m_body);
    };
    forNodes(read);
    return m_moved;
}

// Applies the guard, again and again while nodes that stopped each other go on with their common motion. Only cloth
// that nothing holds does: elsewhere it would stretch what leads to the held nodes.
GuardResult ClothMeetings::applyGuard(bool carries, const BodySet& fixed)
{
    m_isShared.assign(m_set.nodeCount(), 0);
    m_impacts.clear(m_set.nodeCount());
    BodySet held = fixed;
    for (std::size_t i = 0; i < m_members.size(); ++i)
    {
        const auto first = m_isHeld.begin() + std::ptrdiff_t(m_set.firstNode(i));
        const auto last = m_isHeld.begin() + std::ptrdiff_t(m_set.firstNode(i + 1));
        if (std::find(first, last, 1) != last || hangs(*m_members[i].m_body)) held.insert(m_members[i].m_body);
    }
    for (int turn = 1;; ++turn)
    {
        const std::vector<float> whole(m_set.end(), m_set.end() + 3 * m_set.nodeCount());
        const GuardResult result = m_guard.apply(
            m_set, m_isHeld, [this](const std::uint32_t* nodes) { return isGuarded(nodes); },
            m_state.settings().m_candidateLimit, m_state.threads(), carries);
        if (result.m_shortened == 0) return result;
        const bool mayGoOn = turn < kMostTurns && !result.m_tooMany;
        if (!slowDown(whole, held, turn > kTurnsWithShares, mayGoOn)) return result;
    }
}

// Slows nodes down that did not go their whole way. held: bodies that hang or lie on what takes momentum. sticks: nodes
// of an impact have no motion of their own. mayGoOn: nodes may go on together. Returns whether they do: then the ends
// of all ways are new, and need the guard.
bool ClothMeetings::slowDown(const std::vector<float>& whole, const BodySet& held, bool sticks, bool mayGoOn)
{
    const auto join = [this](const std::uint32_t* nodes)
    {
        for (int k = 0; k < 4; ++k)
            m_impacts.join(nodes[0], nodes[k]);
    };
    m_guard.forStopped(join);
    m_impacts.nameGroups();
    std::vector<StoppedNode> speeds, ways;
    const auto read = [&](const Member& member, const btSoftBody::Node& node, std::size_t index)
    {
        const bool moves = !m_isHeld[index] && !m_guard.isCarried(index);
        const Vec3d start = pointAt(m_set.start(), index);
        speeds.push_back({start, wideOf(node.m_v), moves ? 1 / double(node.m_im) : 0, m_guard.shares()[index],
                          m_impacts.groupOf(index), held.count(member.m_body) > 0});
        ways.push_back(speeds.back());
        ways.back().m_velocity = pointAt(whole.data(), index) - start;
    };
    forNodes(read);
    drape::slowDown(speeds, sticks ? ImpactMotion::Common : ImpactMotion::Shares);
    const bool goesOn = mayGoOn && drape::slowDown(ways, sticks ? ImpactMotion::Straight : ImpactMotion::Shares);
    const auto write = [&](const Member&, btSoftBody::Node& node, std::size_t index)
    {
        const StoppedNode& speed = speeds[index];
        const bool isStopped = speed.m_impact != NodeGroups::kNone && speed.m_mass > 0;
        const bool isFree = isStopped && !speed.m_isHeld;
        // Ways that others hold are stopped again in the next turn.
        if (isFree || (isStopped && !goesOn)) node.m_v = narrowOf(speed.m_velocity);
        if (!goesOn) return;
        float* end = m_set.end() + 3 * index;
        std::copy_n(whole.data() + 3 * index, 3, end);
        if (!isFree) return;
        writePosition(narrowOf(ways[index].m_place + ways[index].m_velocity), end);
        m_isShared[index] = 1;
    };
    forNodes(write);
    return goesOn;
}

// Lists the pairs of the last guard() that are not guarded.
void ClothMeetings::listFlagged()
{
    std::vector<FlaggedPair>& all = m_state.m_flagged;
    all.erase(std::remove_if(all.begin(), all.end(), [](const FlaggedPair& pair) { return pair.m_otherBody; }),
              all.end());
    const auto add = [&](const std::uint32_t* nodes, int split, int count, PairFlag flag)
    {
        FlaggedPair pair = {};
        pair.m_flag = flag;
        const std::size_t first = m_set.memberOf(nodes[0]), second = m_set.memberOf(nodes[split]);
        pair.m_body = m_members[first].m_body;
        pair.m_object = pair.m_otherBody = m_members[second].m_body;
        pair.m_part = pair.m_triangle = -1;
        for (int k = 0; k < 3; ++k)
        {
            pair.m_nodes[k] = k < split ? int(nodes[k] - m_set.firstNode(first)) : -1;
            pair.m_otherNodes[k] = k < count - split ? int(nodes[split + k] - m_set.firstNode(second)) : -1;
        }
        all.push_back(pair);
    };
    for (std::size_t i = 0; i < m_meeting.size(); i += 6)
        add(m_meeting.data() + i, 3, 6, PairFlag::StartsIntersecting);
    m_guard.forFlagged([&](const std::uint32_t* nodes, int split, bool isForced)
                       { add(nodes, split, 4, isForced ? PairFlag::Forced : PairFlag::Touches); });
}

float ClothMeetings::impactShare(const btSoftBody& body) const
{
    const auto isBody = [&](const Member& member) { return member.m_body == &body; };
    const auto found = std::find_if(m_members.begin(), m_members.end(), isBody);
    if (found == m_members.end()) return 0;
    const std::size_t member = std::size_t(found - m_members.begin());
    const auto first = m_isShared.begin() + std::ptrdiff_t(m_set.firstNode(member));
    const auto last = m_isShared.begin() + std::ptrdiff_t(m_set.firstNode(member + 1));
    return float(std::count(first, last, 1)) / float(last - first);
}

void ClothMeetings::addNear(BodySet& bodies) const
{
    const auto add = [&](const std::uint32_t* nodes)
    {
        const btSoftBody* const first = m_members[m_set.memberOf(nodes[0])].m_body;
        const btSoftBody* const second = m_members[m_set.memberOf(nodes[3])].m_body;
        if (bodies.count(first) > 0) bodies.insert(second);
        if (bodies.count(second) > 0) bodies.insert(first);
    };
    m_guard.forPairs(add);
}

void ClothMeetings::addTo(HeldGroup& group, const BodySet& bodies) const
{
    for (std::size_t i = 0; i < m_members.size(); ++i)
    {
        const Member& member = m_members[i];
        if (bodies.count(member.m_body) == 0) continue;
        const std::size_t first = m_set.firstNode(i);
        if (member.m_isStepped)
            group.add(*member.m_body, [this, first](std::size_t node) { return startOf(first + node); });
        else
            group.rest();
    }
}

void ClothMeetings::endHold()
{
    readEnds();
    keepEnds();
    reportUnguarded();
}

void ClothMeetings::readEnds()
{
    const auto write = [this](const Member&, const btSoftBody::Node& node, std::size_t index)
    {
        float* end = m_set.end() + 3 * index;
        writePosition(node.m_x, end);
    };
    forNodes(write);
}

// Remembers where the step leaves the nodes.
void ClothMeetings::keepEnds()
{
    for (std::size_t i = 0; i < m_members.size(); ++i)
    {
        SelfColliding& self = *m_members[i].m_self;
        self.m_ends.assign(m_set.end() + 3 * m_set.firstNode(i), m_set.end() + 3 * m_set.firstNode(i + 1));
        self.m_solver = this;
        self.m_step = m_step;
    }
}

// Counts and lists the triangles that intersect where the step ends: cloth stood still, but held nodes moved.
void ClothMeetings::reportUnguarded()
{
    m_isClean = false;
    const std::vector<float> starts(m_set.start(), m_set.start() + 3 * m_set.nodeCount());
    std::vector<std::uint32_t> startMeeting;
    startMeeting.swap(m_meeting);
    std::copy(m_set.end(), m_set.end() + 3 * m_set.nodeCount(), m_set.start());
    listMeeting();
    std::copy(starts.begin(), starts.end(), m_set.start());
    StepStatistics& statistics = m_state.m_statistics;
    statistics.m_clothPairsMeeting = m_meeting.size() / 6;
    statistics.m_status |= kStepMotionHeldBack;
    if (statistics.m_clothPairsMeeting > 0) statistics.m_status |= kStepClothsMeet;
    listFlagged();
    m_meeting.swap(startMeeting);
}
}  // namespace drape
