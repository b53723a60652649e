#include "drape/plugin.h"

#include <cinttypes>
#include <cstdio>
#include <utility>

#include "BulletCollision/CollisionDispatch/btCollisionWorld.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "bullet_plugin/adapter/cloth_cloth/soft_body_filters.h"
#include "bullet_plugin/adapter/pairs/eligibility.h"
#include "bullet_plugin/adapter/wiring/diagnosis.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/adapter/wiring/wiring.h"
#include "bullet_plugin/core/public_call.h"

namespace drape
{
namespace
{
// Returns the first reason among the leaves of a shape at that pose; empty if every leaf is handled.
std::string reasonInShape(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                          const btCollisionShape& shape, const btTransform& pose)
{
    if (shape.getShapeType() != COMPOUND_SHAPE_PROXYTYPE)
    {
        const char* reason = reasonForStock(state, cloth, obstacle, shape);
        if (!reason) reason = reasonFromDispatcher(state, cloth, obstacle, shape);
        return reason ? reason : "";
    }
    const btCompoundShape& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
    {
        const btTransform childPose = pose * compound.getChildTransform(i);
        const std::string reason = reasonInShape(state, cloth, obstacle, *compound.getChildShape(i), childPose);
        if (reason.empty()) continue;
        const bool nobodys = !stockCanTake(obstacle, *compound.getChildShape(i), childPose);
        return "child " + std::to_string(i) + " of the compound: " + reason +
               (nobodys ? "; Bullet's own algorithm would assume this mesh to be where the compound is, so that it "
                          "collides with nothing"
                        : "");
    }
    return std::string();
}

// Returns why Bullet's own algorithm has a soft body with another one, or with itself; empty if Drape has.
std::string reasonBetween(PluginState& state, const btSoftBody& body, const btSoftBody& other)
{
    const SelfColliding* const first = state.m_selfCollision.find(body);
    const SelfColliding* const second = state.m_selfCollision.find(other);
    if (&body == &other)
        return first && first->m_meetsItself ? std::string()
                                             : "the soft body's self collision is off: Plugin::setSelfCollision";
    if (!first || !second || !first->m_meetsOthers || !second->m_meetsOthers)
        return "both objects are soft bodies, which Plugin::setSelfCollision of both lets collide";
    return filtersLetMeet(body, other) ? std::string() : "Bullet's filters keep the two soft bodies apart";
}

std::string reasonOf(PluginState& state, const btCollisionObject* objectA, const btCollisionObject* objectB)
{
    if (!objectA || !objectB) return "one of the objects is missing";
    const btSoftBody* cloth = btSoftBody::upcast(objectA);
    const btCollisionObject* obstacle = objectB;
    if (!cloth)
    {
        cloth = btSoftBody::upcast(objectB);
        obstacle = objectA;
    }
    if (!cloth) return "neither object is a soft body";
    if (!obstacle->getCollisionShape()) return "the obstacle has no collision shape";
    if (const btSoftBody* other = btSoftBody::upcast(obstacle)) return reasonBetween(state, *cloth, *other);
    return reasonInShape(state, *cloth, *obstacle, *obstacle->getCollisionShape(), obstacle->getWorldTransform());
}

std::string reportOf(const Plugin& plugin, const Error& error)
{
    if (!plugin.ready()) return "Drape is off: " + error.m_call;
    const StepStatistics& step = plugin.statistics();
    char line[320];
    std::snprintf(
        line, sizeof(line), ": %zu cloth and %zu obstacle triangles, %" PRIu64 " candidates, %zu contacts, %.3f ms",
        step.m_clothTriangles, step.m_obstacleTriangles, step.m_candidates, step.m_contacts, step.collisionMs());
    const std::string remark = step.m_skipped ? "nothing to do" : statusText(step.m_status);
    const DeviceReport& device = plugin.device();
    return "Drape on " + device.m_device.m_name + " (" + device.m_reason + ")" + line +
           (remark.empty() ? "" : " (" + remark + ")");
}

// A short text, so that the string allocates no memory.
std::string outOfMemory()
{
    return kOutOfMemory;
}

// Returns work(), or why that failed.
template <class Work>
std::string textOf(const Work& work)
{
    return guarded(work, [](const CaughtException& caught)
                   { return guardedOr(outOfMemory(), [&] { return std::string(caught.m_text); }); });
}

// Answer of a plugin without a state: memory ran out while it was made.
const DeviceReport& noDevice()
{
    static const DeviceReport report = []
    {
        DeviceReport none;
        none.m_device.m_name = "none";
        none.m_reason = kOutOfMemory;
        return none;
    }();
    return report;
}
}  // namespace

Plugin::Plugin(const Settings& settings)
    : m_state(guardedOr(std::shared_ptr<PluginState>(), [&] { return std::make_shared<PluginState>(settings); }))
{
}

Plugin::~Plugin()
{
    const DefaultFloats floats;
    if (m_state) m_state->m_kept.retire();
    m_state.reset();
}

bool Plugin::ready() const
{
    return m_state && m_state->ready();
}

std::string Plugin::error() const
{
    if (!m_state) return outOfMemory();
    return textOf([&] { return m_state->error().failed() ? m_state->error().text() : std::string(); });
}

void Plugin::awaitDevice()
{
    if (!m_state) return;
    guarded([&] { m_state->takeDevice(true); },
            [&](const CaughtException& caught) { m_state->fail("drape::Plugin::awaitDevice", caught); });
}

const DeviceReport& Plugin::device() const
{
    return m_state ? m_state->device() : noDevice();
}

const StepStatistics& Plugin::statistics() const
{
    static const StepStatistics none;
    return m_state ? m_state->m_statistics : none;
}

std::vector<ContactInfo> Plugin::contacts() const
{
    if (!m_state) return {};
    return guardedOr(std::vector<ContactInfo>(), [&] { return m_state->m_found.list(); });
}

std::vector<ClothPairInfo> Plugin::clothPairs() const
{
    if (!m_state) return {};
    return guardedOr(std::vector<ClothPairInfo>(), [&] { return m_state->m_clothPairs; });
}

std::vector<FlaggedPair> Plugin::flaggedPairs() const
{
    if (!m_state) return {};
    return guardedOr(std::vector<FlaggedPair>(), [&] { return m_state->m_flagged; });
}

void Plugin::recordContacts(bool record)
{
    if (m_state) m_state->m_asksRecords = record;
}

const std::vector<StepContact>& Plugin::stepContacts() const
{
    static const std::vector<StepContact> none;
    return m_state ? m_state->m_records.list() : none;
}

void Plugin::setContactListener(ContactListener listener)
{
    if (!m_state) return;
    const auto set = [&]
    {
        std::shared_ptr<const ContactListener> next;
        if (listener) next = std::make_shared<const ContactListener>(std::move(listener));
        m_state->m_listener = std::move(next);
        return true;
    };
    guardedOr(false, set);
}

std::string Plugin::whyStock(const btCollisionObject* objectA, const btCollisionObject* objectB) const
{
    if (!m_state) return outOfMemory();
    return textOf([&] { return reasonOf(*m_state, objectA, objectB); });
}

std::string Plugin::whyBulletSolves(const btSoftBody& body) const
{
    if (!m_state) return outOfMemory();
    return textOf(
        [&]
        { return std::string(reasonForBulletsLinks(*m_state, body) ? reasonForBulletsLinks(*m_state, body) : ""); });
}

std::string Plugin::diagnose(const btCollisionWorld& world) const
{
    if (!m_state) return outOfMemory();
    return textOf([&] { return diagnosisOf(*this, world); });
}

void Plugin::prepare(const btCollisionObject* object)
{
    if (m_state) m_state->prepare(&object, 1);
}

void Plugin::prepare(const btCollisionWorld& world)
{
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    if (m_state && objects.size() > 0) m_state->prepare(&objects[0], objects.size());
}

void Plugin::release(const btCollisionObject* object)
{
    if (m_state) m_state->release(object);
}

void Plugin::release(const btCollisionWorld& world)
{
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i)
        release(objects[i]);
}

std::string Plugin::keepOnDevice(btSoftBody& body, bool keep)
{
    if (!m_state) return outOfMemory();
    return textOf(
        [&]
        {
            if (keep)
            {
                const char* const reason = m_state->m_kept.keep(body);
                return std::string(reason ? reason : "");
            }
            m_state->m_kept.release(body);
            return std::string();
        });
}

void Plugin::takeNodes(const btSoftBody& body)
{
    if (m_state) m_state->m_kept.takeNodes(body);
}

void Plugin::beginFetch(const btSoftBody& body)
{
    if (m_state) m_state->m_kept.beginFetch(body);
}

bool Plugin::fetch(btSoftBody& body)
{
    return m_state && guardedOr(false, [&] { return m_state->m_kept.fetch(body); });
}

bool Plugin::fetch(const btSoftBody& body, const NodeArrays& arrays)
{
    return m_state && guardedOr(false, [&] { return m_state->m_kept.fetch(body, arrays); });
}

void Plugin::obstacleChanged(const btCollisionShape* shape)
{
    if (m_state) m_state->obstacleChanged(shape);
}

void Plugin::teleported(const btCollisionObject* object)
{
    if (m_state && object) m_state->teleported(object);
}

void Plugin::updateNodeTree(btSoftBody& body)
{
    const DefaultFloats floats;
    if (m_state) m_state->updateNodeTree(body);
}

void Plugin::updateNodeTrees(const btCollisionWorld& world)
{
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i)
        if (btSoftBody* const body = btSoftBody::upcast(objects[i])) updateNodeTree(*body);
}

void Plugin::setOneSided(const btCollisionShape* shape, bool oneSided)
{
    if (m_state) m_state->setOneSided(shape, oneSided);
}

void Plugin::setTriangleFilter(const btCollisionShape* shape, TriangleFilter filter)
{
    if (m_state) m_state->setTriangleFilter(shape, std::move(filter));
}

void Plugin::setSelfCollision(const btSoftBody& body, bool collides, double thickness)
{
    if (!m_state) return;
    if (collides)
        guardedOr(false,
                  [&]
                  {
                      m_state->m_selfCollision.set(body, btScalar(thickness));
                      if (!(thickness >= 0)) m_state->tellThickness(body, thickness);
                      return true;
                  });
    else
        m_state->m_selfCollision.clear(body);
}

std::string Plugin::report() const
{
    if (!m_state) return outOfMemory();
    return textOf([&] { return reportOf(*this, m_state->error()); });
}
}  // namespace drape
