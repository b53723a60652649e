// Takes the contacts of a step's detections, ends paths before what they would pass, and detects again.
#include <algorithm>
#include <cmath>

#include "bullet_plugin/adapter/collision/collision_step.h"
#include "bullet_plugin/adapter/collision/stretch.h"
#include "bullet_plugin/adapter/motion/bounds_guard.h"
#include "bullet_plugin/adapter/solver/body_nodes.h"
#include "bullet_plugin/core/pipeline/add_detection.h"
#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
namespace
{
// Factor on the tests that ordinary motion needs, for cloth that came apart or is beside an obstacle that jumps.
constexpr float kMostAllowance = 8;

// Distance from a surface at which a feature is on it, as a share of the thickness.
constexpr float kOnSurface = 1.0f / 256;

// Returns whether one of up to three nodes is held; -1: none.
bool anyHeld(const SolverNodes& nodes, const int feature[3])
{
    return std::any_of(feature, feature + 3,
                       [&](int node) { return node >= 0 && !(nodes.inverseMass(std::size_t(node)) > 0); });
}
}  // namespace

// Takes the contacts of the current detection. If that holds bodies together, detects again and takes the new
// contacts.
void CollisionStep::receiveHeld(Detection detection, const TakeSolved& takeSolved)
{
    receiveAll(detection, takeSolved);
    if (!m_heldTogether) return;
    // Bodies that are examined again are not left out yet.
    StepStatistics& statistics = m_state.m_statistics;
    const auto isLeftOut = [](const BodyContacts& body) { return body.m_leftOut; };
    statistics.m_clothsLeftOut = std::size_t(std::count_if(m_bodies.begin(), m_bodies.end(), isLeftOut));
    if (statistics.m_clothsLeftOut == 0) statistics.m_status &= ~std::uint32_t(kStepClothsLeftOut);
    statistics.m_status |= kStepMotionHeldBack;
    if (detection == Detection::First) detection = Detection::Again;
    namePairs(detection);
    submit(detection);
    receiveAll(detection);
    for (BodyContacts& body : m_bodies)
        body.m_heldTogether = false;
    m_heldTogether = false;
}

void CollisionStep::receive(const ContactList& contacts, Detection detection)
{
    const auto isDone = [detection](const BodyContacts& body)
    { return detection != Detection::Check && body.m_contacts.m_isSolved; };
    BodyContacts* body = nullptr;
    for (std::size_t i = 0; i < contacts.size();)
    {
        const Contact& first = contacts[i];
        const ClothFeature cloth = m_state.pipeline().clothFeature(first);
        if (!body || body->m_cloth != cloth.m_cloth) body = bodyOf(cloth.m_cloth);
        const std::size_t begin = i;
        while (i < contacts.size() && contacts[i].m_featureIndex == first.m_featureIndex)
            ++i;
        if (!body || !isDetected(*body, detection) || isDone(*body)) continue;
        const std::uint32_t count = static_cast<std::uint32_t>(i - begin);
        const OrderedFeature& ordered = body->m_contacts.m_order->features()[cloth.m_index];
        if (body->m_tangled.empty() && !body->m_hasDynamicPair)
            addContacts(*body, &first, count, ordered);
        else
            addChosen(*body, &first, count, ordered, detection);
    }
    for (BodyContacts& pushed : m_bodies)
        if (!isDone(pushed)) addPushes(pushed);
}

// Contacts of one feature of the cloth.
void CollisionStep::addContacts(BodyContacts& body, const Contact* first, std::uint32_t count,
                                const OrderedFeature& ordered)
{
    FeatureContacts feature{first, count, &ordered, 1};
    for (std::uint32_t i = 0; i < count; ++i)
        feature.m_leastTime = std::min(feature.m_leastTime, first[i].m_time);
    body.m_meetsSurface = body.m_meetsSurface || feature.m_leastTime < 1;
    for (int k = 0; k < 3 && ordered.m_nodes[k] >= 0; ++k)
        body.m_contacts.m_limit.addContactNode(ordered.m_nodes[k]);
    body.m_contacts.m_features.push_back(feature);
}

// Returns how many times as many tests as in ordinary motion the cloth may make.
float CollisionStep::allowanceOf(MeshId cloth)
{
    const std::size_t index = m_byCloth.at(cloth);
    BodyContacts& body = m_bodies[index];
    if (body.m_isOnDevice) recordPaths(body);
    const Stretch stretch = stretchOf(*body.m_body, m_mirrors[index]->faces(), body.nodes());
    const bool isApart = stretch.m_start > kMostStretch;
    if (!body.m_heldTogether && (isApart || stretch.m_end > kMostStretch)) return 1;
    return isApart || body.m_heldTogether || body.m_obstacleJumps ? kMostAllowance : HUGE_VALF;
}

// Waits for the current detection. Returns its contacts, none if all bodies are solved.
ContactList CollisionStep::waitForContacts(const TakeSolved& takeSolved)
{
    Pipeline& pipeline = m_state.pipeline();
    const ContactList contacts = pipeline.finish([this](MeshId cloth) { return allowanceOf(cloth); });
    const bool onDevice = pipeline.areContactsOnDevice();
    if (!takeSolved && !onDevice) return contacts;
    const bool isWhole = pipeline.ranOnce() && pipeline.statistics().m_invalidNodes == 0;
    if (takeSolved && onDevice && isWhole) takeSolved();
    const auto isSolved = [](const BodyContacts& body) { return body.m_contacts.m_isSolved; };
    if (std::all_of(m_bodies.begin(), m_bodies.end(), isSolved)) return contacts;
    for (BodyContacts& body : m_bodies)
    {
        body.m_meetsSurface = !isSolved(body);
        if (body.m_meetsSurface) recordPaths(body);
    }
    return pipeline.bringContacts();
}

// Waits for the current detection. Its contacts replace any earlier ones of this step.
void CollisionStep::receiveAll(Detection detection, const TakeSolved& takeSolved)
{
    for (BodyContacts& body : m_bodies)
    {
        body.m_contacts.m_features.clear();
        body.m_dynamicContacts.clear();
    }
    const ContactList contacts = waitForContacts(takeSolved);
    addDetection(m_state.m_statistics, m_state.pipeline().statistics(), detection);
    markUnguarded();
    if (m_state.pipeline().areContactsOnDevice()) return;
    m_state.m_found.set(m_state.pipeline(), contacts);
    receive(contacts, detection);
}

// Lists the body's contacts that its nodes' paths meet. found: if not null, gets the pipeline's, in the same order.
std::vector<SolverContact> CollisionStep::impactsOf(const BodyContacts& body, std::vector<const Contact*>* found) const
{
    std::vector<SolverContact> impacts;
    for (const FeatureContacts& feature : body.m_contacts.m_features)
        for (std::uint32_t i = 0; feature.m_leastTime < 1 && i < feature.m_count; ++i)
        {
            if (!(feature.m_contacts[i].m_time < 1)) continue;
            impacts.push_back(body.m_contacts.resolve(m_state.m_found.source(), feature.m_contacts[i]));
            if (found) found->push_back(feature.m_contacts + i);
        }
    return impacts;
}

// Lists the body's contacts with dynamic obstacles that its nodes' paths meet, until the bodies are solved.
std::vector<SolverContact> CollisionStep::dynamicImpactsOf(const BodyContacts& body) const
{
    std::vector<SolverContact> impacts;
    for (const DynamicContact& dynamic : body.m_dynamicContacts)
        if (dynamic.m_contact->m_time < 1)
            impacts.push_back(body.m_contacts.resolve(m_state.m_found.source(), *dynamic.m_contact));
    return impacts;
}

bool CollisionStep::cutAtImpactsOf(BodyContacts& body, Cut cut, std::vector<Vec3>* slides)
{
    const float perSecond = body.m_contacts.m_movesOnly ? 0 : body.perSecond();
    const bool records = m_state.m_records.isOn();
    std::vector<const Contact*> found;
    std::vector<Vec3> impulses;
    const std::vector<SolverContact> impacts = impactsOf(body, records ? &found : nullptr);
    if (!cutAtImpacts(body.nodes(), impacts, cut, perSecond, slides, records ? &impulses : nullptr)) return false;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (vec3Dot(impulses[i], impulses[i]) > 0)
            m_state.m_records.add(ContactRecords::pushOf(m_state.m_found, *found[i], impulses[i]));
    writeShifted(body.nodes(), *body.m_body);
    return true;
}

// Cuts paths where they meet dynamic obstacles, for the detection alone: what cloth and obstacle give each other there
// is for the solver to find out.
bool CollisionStep::cutBeforeDynamic(BodyContacts& body)
{
    const std::vector<SolverContact> impacts = dynamicImpactsOf(body);
    for (const SolverContact& impact : impacts)
        for (int k = 0; k < 3 && impact.m_nodes[k] >= 0; ++k)
        {
            const btSoftBody::Node& node = body.m_body->m_nodes[impact.m_nodes[k]];
            body.m_wholePaths.emplace(impact.m_nodes[k], PathEnd{node.m_x, node.m_v});
        }
    for (const SolverContact& impact : impactsOf(body))
        for (int k = 0; k < 3 && impact.m_nodes[k] >= 0; ++k)
            body.m_wholePaths.erase(impact.m_nodes[k]);
    if (!cutAtImpacts(body.nodes(), impacts, Cut::EachNode, 0)) return false;
    writeShifted(body.nodes(), *body.m_body);
    return true;
}

// Gives nodes back the paths that dynamic obstacles cut.
void CollisionStep::restorePaths()
{
    for (BodyContacts& body : m_bodies)
        for (const auto& whole : body.m_wholePaths)
        {
            btSoftBody::Node& node = body.m_body->m_nodes[whole.first];
            node.m_x = whole.second.m_position;
            node.m_v = whole.second.m_velocity;
            recordEnd(node, std::size_t(whole.first), body.nodes());
        }
}

// Thin cloth meets surfaces in most steps and slides on; thicker cloth stops where it meets one.
bool CollisionStep::cutPaths()
{
    bool any = false;
    for (BodyContacts& body : m_bodies)
    {
        const btSoftBody& cloth = *body.m_body;
        const float way = float(cloth.m_worldInfo->m_gravity.length() * cloth.m_sst.sdt * cloth.m_sst.sdt);
        const bool isThin = way > DRAPE_THIN_SHARE * body.m_contacts.m_leastThickness;
        any = cutBeforeDynamic(body) || any;
        any = cutAtImpactsOf(body, Cut::EachNode, isThin ? &body.m_contacts.m_slides : nullptr) || any;
    }
    return any;
}

void CollisionStep::finish(const TakeSolved& takeSolved)
{
    m_state.m_statistics = StepStatistics();
    m_state.m_statistics.m_skipped = m_pairs.empty();
    if (m_fieldsLeftOut) m_state.m_statistics.m_status |= kStepClothsLeftOut;
    if (m_state.pipeline().deviceFailed()) m_state.m_statistics.m_status |= kStepDeviceFailed;
    for (const ClothMirror* cloth : m_mirrors)
        if (cloth->hasForeignFaces()) m_state.m_statistics.m_status |= kStepFacesLeftOut;
    if (m_pairs.empty()) return;
    m_state.m_statistics.m_startsIntersecting = m_starts.intersectingPairs();
    m_state.m_statistics.m_startIntersections = m_starts.intersections();
    if (m_starts.intersectingPairs() > 0) m_state.m_statistics.m_status |= kStepStartsIntersecting;
    receiveHeld(Detection::First, takeSolved);
    for (int detections = 1; detections < kMostDetections && cutPaths(); ++detections)
    {
        namePairs(Detection::Again);
        submit(Detection::Again);
        receiveHeld(Detection::Again);
    }
    restorePaths();
}

bool CollisionStep::cutOffPath(Cut cut)
{
    bool any = false;
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        if (!m_bodies[i].m_isOffPath || !cutAtImpactsOf(m_bodies[i], cut, nullptr)) continue;
        m_mirrors[i]->watch(true);
        m_bodies[i].m_isStopped = true;
        any = true;
    }
    return any;
}

void CollisionStep::addStopped(BodySet& bodies) const
{
    for (const BodyContacts& body : m_bodies)
        if (body.m_isStopped && !body.m_hasDynamicPair) bodies.insert(body.m_body);
}

// Returns whether cloth beside dynamic obstacles ends the last detection's paths behind a surface, however short these
// were: several bodies may squeeze it.
bool CollisionStep::endsBehind(const BodyContacts& body)
{
    if (!body.m_hasDynamicPair || !body.m_tangled.empty()) return false;
    const auto isBehind = [](const FeatureContacts& feature)
    {
        return std::any_of(feature.m_contacts, feature.m_contacts + feature.m_count,
                           [](const Contact& contact) { return contact.m_gap1 < 0; });
    };
    return std::any_of(body.m_contacts.m_features.begin(), body.m_contacts.m_features.end(), isBehind);
}

// Returns whether dynamic obstacles leave the body no room.
bool CollisionStep::isJammed(const BodyContacts& body) const
{
    return body.m_isOffPath && body.m_hasDynamicPair && (passesSurface(body) || leavesBounds(m_state, *body.m_body));
}

void CollisionStep::addSharers(BodySet& bodies) const
{
    std::unordered_set<const btRigidBody*> objects;
    for (std::size_t before = 0; before != bodies.size() + objects.size();)
    {
        before = bodies.size() + objects.size();
        for (const Pair& pair : m_pairs)
        {
            const btSoftBody* const body = pair.m_note.m_cloth;
            if (!dynamicOf(pair.m_obstacle) || (bodies.count(body) == 0 && objects.count(pair.m_note.m_dynamic) == 0))
                continue;
            bodies.insert(body);
            objects.insert(pair.m_note.m_dynamic);
        }
    }
}

// Returns whether a body of the last detection has contacts within reach of an obstacle that does not yield.
bool CollisionStep::touchesFixed(const BodyContacts& body) const
{
    if (!body.m_pushes.empty()) return true;
    for (const FeatureContacts& feature : body.m_contacts.m_features)
        for (std::uint32_t i = 0; i < feature.m_count; ++i)
            if (!dynamicOf(m_state.pipeline().view(feature.m_contacts[i]).m_obstacle)) return true;
    return false;
}

BodySet CollisionStep::listFixed() const
{
    BodySet fixed;
    for (const BodyContacts& body : m_bodies)
        if (touchesFixed(body)) fixed.insert(body.m_body);
    return fixed;
}

void CollisionStep::addTo(HeldGroup& group, const BodySet& bodies)
{
    for (BodyContacts& body : m_bodies)
    {
        if (bodies.count(body.m_body) == 0) continue;
        group.add(*body.m_body, [&body](std::size_t node) { return vectorOf(body.nodes().start(node)); });
        if (touchesFixed(body)) group.rest();
    }
    for (const Pair& pair : m_pairs)
        if (dynamicOf(pair.m_obstacle) && bodies.count(pair.m_note.m_cloth) > 0)
            group.add(*pair.m_note.m_dynamic, pair.m_note.m_noted);
}

// Takes over where bodies and dynamic obstacles were put.
void CollisionStep::endHold(const BodySet& bodies)
{
    for (BodyContacts& body : m_bodies)
    {
        if (bodies.count(body.m_body) == 0) continue;
        body.m_isOffPath = true;
        for (int i = 0; i < body.m_body->m_nodes.size(); ++i)
            recordEnd(body.m_body->m_nodes[i], std::size_t(i), body.nodes());
    }
    followDynamic();
    m_state.m_statistics.m_status |= kStepMotionHeldBack;
}

// Holds the bodies that dynamic obstacles leave no room, with these obstacles. Returns whether there are any.
bool CollisionStep::holdJammed()
{
    BodySet held;
    for (const BodyContacts& body : m_bodies)
    {
        if (held.count(body.m_body) > 0 || !isJammed(body)) continue;
        BodySet bodies = {body.m_body};
        addSharers(bodies);
        HeldGroup group;
        addTo(group, bodies);
        group.hold();
        held.insert(bodies.begin(), bodies.end());
    }
    if (held.empty()) return false;
    endHold(held);
    return true;
}

void CollisionStep::checkHeld(const BodySet& bodies)
{
    endHold(bodies);
    detectRealPaths();
    reportPassed();
}

// Reports bodies whose paths still pass a surface after the last cut. The next step checks them where they are,
// except at nodes that the app moves.
void CollisionStep::reportPassed()
{
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        if (!m_bodies[i].m_isOffPath) continue;
        std::vector<SolverContact> impacts = impactsOf(m_bodies[i]);
        const SolverNodes& nodes = m_bodies[i].nodes();
        const auto isHeld = [&](const SolverContact& impact) { return anyHeld(nodes, impact.m_nodes); };
        impacts.erase(std::remove_if(impacts.begin(), impacts.end(), isHeld), impacts.end());
        if (anyCuts(impacts)) tellPassed(i);
    }
}

// Returns whether a feature starts or ends the step on a surface. It may leave that to either side: no contact can tell
// which is right.
bool CollisionStep::meetsSurface(const BodyContacts& body) const
{
    const float most = kOnSurface * body.m_contacts.m_leastThickness;
    for (const FeatureContacts& feature : body.m_contacts.m_features)
        for (std::uint32_t i = 0; i < feature.m_count; ++i)
        {
            const Contact& contact = feature.m_contacts[i];
            const float least = std::min(std::fabs(contact.m_gap0), std::fabs(contact.m_gap1));
            if (least < most && !anyHeld(body.nodes(), feature.nodes())) return true;
        }
    return false;
}

void CollisionStep::tellPassed(std::size_t body)
{
    m_state.m_statistics.m_status |= kStepSurfacePassed;
    m_mirrors[body]->startAnew();
}

void CollisionStep::reportMeetingDeformed()
{
    for (const Pair& pair : m_pairs)
    {
        const std::size_t body = m_byCloth.at(pair.m_cloth);
        if (!pair.m_carriedStarts || m_bodies[body].m_leftOut || !m_starts.endsMeeting(pair.m_start)) continue;
        tellPassed(body);
    }
}

// Returns null for an obstacle that does not yield.
const DynamicBody* CollisionStep::dynamicOf(MeshId obstacle) const
{
    const auto found = m_dynamic.find(obstacle);
    return found == m_dynamic.end() ? nullptr : &found->second;
}

void CollisionStep::followDynamic()
{
    for (Pair& pair : m_pairs)
    {
        if (!pair.m_note.m_dynamic) continue;
        ObstacleMirror& mirror = m_state.obstacleMirror(pair.m_note);
        pair.m_note.endMotion();
        pair.m_start.m_motion = pair.m_note.m_motion;
        mirror.follow(m_state.pipeline(), pair.m_note.m_motion);
        mirror.setBodyEnd(pair.m_note.m_dynamic->getWorldTransform());
        m_state.m_found.nameObstacle(mirror, pair.m_note.m_motion);
        BodyContacts& body = *bodyOf(pair.m_cloth);
        body.m_contacts.m_movesOnly = body.m_hasDynamicPair;
        watch(*body.m_body);
    }
}

void CollisionStep::detectRealPaths()
{
    namePairs(Detection::Check);
    submit(Detection::Check);
    receiveHeld(Detection::Check);
}

std::vector<BodyContacts*> CollisionStep::checkOffPath()
{
    std::vector<BodyContacts*> bodies;
    for (std::size_t i = 0; i < m_bodies.size(); ++i)
    {
        BodyContacts& body = m_bodies[i];
        ClothContacts& contacts = body.m_contacts;
        const bool mayHavePassed = contacts.m_mayHavePassed && !contacts.m_isFiltered;
        body.m_isOffPath = !body.m_isOnDevice &&
                           (mayHavePassed || m_mirrors[i]->isWatched() || contacts.m_limit.anyOffPath(body.nodes()));
        m_mirrors[i]->watch(false);
        body.m_isStopped = false;
        if (body.m_isOffPath) bodies.push_back(&body);
    }
    if (bodies.empty()) return {};
    // Keeps the reported contacts as the solver received them.
    m_state.m_found.keepList();
    for (int detections = 1;; ++detections)
    {
        detectRealPaths();
        if (detections > kMostDetections)
        {
            if (holdJammed()) detectRealPaths();
            reportPassed();
            return {};
        }
        if (!cutOffPath(detections < kMostDetections ? Cut::EachNode : Cut::WholeBody)) break;
    }
    if (holdJammed())
    {
        detectRealPaths();
        reportPassed();
    }
    bodies.erase(std::remove_if(bodies.begin(), bodies.end(), [](const BodyContacts* body) { return body->m_leftOut; }),
                 bodies.end());
    return bodies;
}
}  // namespace drape
