#include "bullet_plugin/adapter/pairs/eligibility.h"

#include "BulletCollision/BroadphaseCollision/btBroadphaseProxy.h"
#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_plugin/adapter/mirrors/convex_reader.h"
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"
#include "bullet_plugin/adapter/mirrors/solid_links.h"
#include "bullet_plugin/adapter/solver/substep_body.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"

namespace drape
{
namespace
{
// Returns why Drape does not handle cloth that a solver of the plugin steps; null if it does.
const char* reasonFromSteppedCloth(const PluginState& state, const btSoftBody& cloth)
{
    if (!state.isWired())
        return "no dispatcher has this plugin's algorithm: make it with a drape::CollisionConfiguration, or call "
               "drape::install()";
    if (cloth.m_reducedModel) return "the soft body is a reduced deformable model";
    if (cloth.m_cfg.collisions & btSoftBody::fCollision::SDF_RD)
        return "the soft body collides as a deformable (SDF_RD)";
    if (!(cloth.m_cfg.collisions & btSoftBody::fCollision::SDF_RS))
        return "the soft body does not collide by its nodes (SDF_RS is off, cluster mode)";
    if (cloth.m_faces.size() > 0) return nullptr;
    if (cloth.m_tetras.size() > 0) return "the soft body has tetrahedra but no faces";
    if (!hasSolidLink(cloth)) return "the soft body has neither faces nor links that could collide without them";
    return nullptr;
}

const char* reasonFromCloth(const PluginState& state, const btSoftBody& cloth)
{
    if (!state.ready()) return "Drape could not start; see Plugin::error()";
    if (!state.steps(cloth))
        return "the world's soft body solver is not a drape::SoftBodySolver of this plugin: give one to the world's "
               "constructor; deformable worlds stay with Bullet";
    return reasonFromSteppedCloth(state, cloth);
}

const char* reasonFromObstacle(const PluginState& state, const btCollisionObject& obstacle,
                               const btCollisionShape& shape)
{
    const bool isDynamic = !obstacle.isStaticOrKinematicObject(), isRigid = btRigidBody::upcast(&obstacle) != nullptr;
    if (!isReadable(shape)) return "the obstacle is not a triangle mesh, plane, height field or convex shape in 3D";
    if (isDynamic && !isRigid && !isLink(obstacle))
        return "the obstacle is dynamic, and neither a rigid body nor a link of a multibody";
    if (state.settings().m_surfaces == ShapeContacts::Bullet && isSurfaceShape(shape))
        return "Settings::m_surfaces leaves planes and height fields to Bullet";
    if (state.settings().m_staticConvex == ShapeContacts::Bullet && isConvexShape(shape) && !(isDynamic && isRigid))
        return "Settings::m_staticConvex leaves convex shapes of other than dynamic bodies to Bullet";
    return nullptr;
}

// Pushes between cloth and a dynamic obstacle go through the core's substeps.
const char* reasonFromDynamic(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                              const btCollisionShape& shape)
{
    if (obstacle.isStaticOrKinematicObject() || isLink(obstacle)) return nullptr;
    if (state.settings().m_dynamicConvex == ShapeContacts::Bullet && isConvexShape(shape))
        return "Settings::m_dynamicConvex leaves convex shapes of dynamic bodies to Bullet";
    if (reasonFromSettings(state, cloth)) return "the obstacle is dynamic, and Bullet solves the soft body's links";
    return nullptr;
}

bool disabledFor(const btSoftBody& cloth, const btCollisionObject& obstacle)
{
    return cloth.m_collisionDisabledObjects.findLinearSearch(&obstacle) != cloth.m_collisionDisabledObjects.size();
}
}  // namespace

const char* reasonForStock(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                           const btCollisionShape& shape)
{
    if (const char* reason = reasonFromCloth(state, cloth)) return reason;
    if (const char* reason = reasonFromObstacle(state, obstacle, shape)) return reason;
    return reasonFromDynamic(state, cloth, obstacle, shape);
}

const char* reasonFromSettings(const PluginState& state, const btSoftBody& body)
{
    if (!state.ready()) return "Drape could not start; see Plugin::error()";
    if (state.settings().m_solver == Solver::Bullet) return "Settings::m_solver leaves links to Bullet";
    if (!state.steps(body)) return "the world's soft body solver is not a drape::SoftBodySolver of this plugin";
    return SubstepBody::reasonFromSettings(body);
}

const char* reasonForBulletsLinks(const PluginState& state, const btSoftBody& body)
{
    if (const char* reason = reasonFromSettings(state, body)) return reason;
    return SubstepBody::reasonForBullet(body);
}

bool handlesCloth(const PluginState& state, const btSoftBody& cloth)
{
    return !reasonFromCloth(state, cloth);
}

bool handlesSteppedCloth(const PluginState& state, const btSoftBody& cloth)
{
    return state.ready() && !reasonFromSteppedCloth(state, cloth);
}

bool isLink(const btCollisionObject& object)
{
    return object.getInternalType() == btCollisionObject::CO_FEATHERSTONE_LINK;
}

bool stockCanTake(const btCollisionObject& obstacle, const btCollisionShape& shape, const btTransform& pose)
{
    return !shape.isConcave() || pose == obstacle.getWorldTransform();
}

bool handlesObstacle(const PluginState& state, const btCollisionObject& obstacle, const btCollisionShape& shape)
{
    return !reasonFromObstacle(state, obstacle, shape);
}

bool handlesAny(const PluginState& state, const btSoftBody& cloth, const btCollisionObject& obstacle,
                const btCollisionShape& shape)
{
    if (shape.getShapeType() != COMPOUND_SHAPE_PROXYTYPE) return !reasonForStock(state, cloth, obstacle, shape);
    const btCompoundShape& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
        if (handlesAny(state, cloth, obstacle, *compound.getChildShape(i))) return true;
    return false;
}

bool respond(const btSoftBody& cloth, const btCollisionObject& obstacle)
{
    return obstacle.hasContactResponse() && !disabledFor(cloth, obstacle);
}
}  // namespace drape
