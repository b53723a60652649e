#include "drape/cloth_world.h"

#include "bullet_plugin/adapter/cloth_world/cloth_world_implementation.h"
#include "bullet_plugin/adapter/wiring/wiring.h"
#include "bullet_plugin/core/check_settings.h"

namespace drape
{
ClothWorld::Implementation::Implementation(const Settings& settings)
    : m_plugin(withNames(settings)),
      m_configuration(m_plugin),
      m_solver(m_plugin),
      m_dispatcher(&m_configuration),
      m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration, &m_solver)
{
}

Settings ClothWorld::Implementation::withNames(Settings settings) const
{
    settings.m_nameOf = [this, appsNameOf = settings.m_nameOf](const btCollisionObject& body)
    {
        const auto index = std::size_t(body.getUserIndex());
        if (index < m_cloths.size() && m_cloths[index].m_body.get() == &body) return "cloth " + std::to_string(index);
        if (index < m_obstacles.size() && m_obstacles[index] && &m_obstacles[index]->body() == &body)
            return "obstacle " + std::to_string(index);
        return appsNameOf ? appsNameOf(body) : std::string();
    };
    return settings;
}

ClothWorld::Implementation::~Implementation()
{
    for (WorldCloth& cloth : m_cloths)
        if (cloth.m_body) removeCloth(cloth);
    for (std::unique_ptr<ObstacleBody>& obstacle : m_obstacles)
        if (obstacle) removeObstacle(obstacle);
}

WorldCloth& ClothWorld::Implementation::cloth(int index)
{
    if (index < 0 || std::size_t(index) >= m_cloths.size() || !m_cloths[std::size_t(index)].m_body)
        throw InvalidInput("there is no cloth " + std::to_string(index));
    return m_cloths[std::size_t(index)];
}

ObstacleBody& ClothWorld::Implementation::obstacle(int index)
{
    if (index < 0 || std::size_t(index) >= m_obstacles.size() || !m_obstacles[std::size_t(index)])
        throw InvalidInput("there is no obstacle " + std::to_string(index));
    return *m_obstacles[std::size_t(index)];
}

int ClothWorld::Implementation::addCloth(const ClothDescription& description)
{
    requireCloth(description);
    m_cloths.reserve(m_cloths.size() + 1);
    WorldCloth made = makeCloth(description, m_world.getWorldInfo(), state().m_selfCollision);
    const int index = int(m_cloths.size());
    made.m_body->setUserIndex(index);
    m_world.addSoftBody(made.m_body.get());
    m_cloths.push_back(std::move(made));
    return index;
}

int ClothWorld::Implementation::addObstacle(const ObstacleDescription& description)
{
    ObstacleBody::check(description);
    m_obstacles.reserve(m_obstacles.size() + 1);
    std::unique_ptr<ObstacleBody> made(new ObstacleBody(description));
    const int index = int(m_obstacles.size());
    made->body().setUserIndex(index);
    if (description.m_oneSided) m_plugin.setOneSided(&made->shape(), true);
    m_world.addRigidBody(&made->body());
    m_obstacles.push_back(std::move(made));
    return index;
}

void ClothWorld::Implementation::removeCloth(WorldCloth& cloth)
{
    m_world.removeSoftBody(cloth.m_body.get());
    m_plugin.setSelfCollision(*cloth.m_body, false);
    m_plugin.release(cloth.m_body.get());
    m_stepped.erase(cloth.m_body.get());
    cloth = WorldCloth();
}

void ClothWorld::Implementation::removeObstacle(std::unique_ptr<ObstacleBody>& obstacle)
{
    m_world.removeRigidBody(&obstacle->body());
    m_plugin.setOneSided(&obstacle->shape(), false);
    m_plugin.setTriangleFilter(&obstacle->shape(), nullptr);
    m_plugin.release(&obstacle->body());
    m_stepped.erase(&obstacle->body());
    obstacle.reset();
}

int ClothWorld::Implementation::indexOf(const btCollisionObject* body) const
{
    const auto found = m_stepped.find(body);
    return found == m_stepped.end() ? -1 : found->second;
}

void ClothWorld::Implementation::noteBodies()
{
    m_stepped.clear();
    for (const WorldCloth& cloth : m_cloths)
        if (cloth.m_body) m_stepped[cloth.m_body.get()] = cloth.m_body->getUserIndex();
    for (const std::unique_ptr<ObstacleBody>& obstacle : m_obstacles)
        if (obstacle) m_stepped[&obstacle->body()] = obstacle->body().getUserIndex();
}

ClothDescription defaultCloth()
{
    ClothDescription cloth = {};
    cloth.m_mass = 1;
    cloth.m_thickness = 0.02;
    cloth.m_stiffness = 1;
    cloth.m_bendingStiffness = 0.02;
    cloth.m_friction = 0.5;
    cloth.m_damping = 0.05;
    cloth.m_iterations = 5;
    return cloth;
}

ObstacleDescription defaultObstacle()
{
    ObstacleDescription obstacle = {};
    obstacle.m_margin = 0.01;
    obstacle.m_friction = 1;
    obstacle.m_rotation[3] = 1;
    return obstacle;
}

ClothWorld::ClothWorld() = default;

ClothWorld::~ClothWorld()
{
    const DefaultFloats floats;
    m_implementation.reset();
}

std::unique_ptr<ClothWorld> ClothWorld::create(const Settings& settings, Error& error)
{
    return guarded(
        [&]
        {
            error = Error();
            if (!checkSettings(settings, error)) return std::unique_ptr<ClothWorld>();
            std::unique_ptr<ClothWorld> world(new ClothWorld());
            world->m_implementation.reset(new Implementation(settings));
            Implementation& made = *world->m_implementation;
            PluginState* const state = made.m_plugin.state().get();
            if (!state) throw std::bad_alloc();
            if (!state->ready())
            {
                error = state->error();
                return std::unique_ptr<ClothWorld>();
            }
            // The solver and the configuration act as Bullet's own if they found no memory.
            if (!state->ownsSolver(&made.m_solver) || pluginOf(made.m_dispatcher) != state) throw std::bad_alloc();
            const double gravity[3] = {0, -9.81, 0};
            world->setGravity(gravity);
            return world;
        },
        [&](const CaughtException& caught)
        {
            setError(error, "drape::ClothWorld::create", caught);
            return std::unique_ptr<ClothWorld>();
        });
}

const Error& ClothWorld::error() const
{
    return m_implementation->m_error;
}

bool ClothWorld::setGravity(const double gravity[3])
{
    Implementation& self = *m_implementation;
    return self.answer(
        "setGravity", false,
        [&]
        {
            requireValues(gravity, 3, "gravity");
            self.m_world.setGravity(btVector3(btScalar(gravity[0]), btScalar(gravity[1]), btScalar(gravity[2])));
            self.m_world.getWorldInfo().m_gravity = self.m_world.getGravity();
            for (const WorldCloth& cloth : self.m_cloths)
                if (cloth.m_body) cloth.m_body->activate();
            return true;
        });
}

int ClothWorld::addCloth(const ClothDescription& cloth)
{
    return m_implementation->answer("addCloth", -1, [&] { return m_implementation->addCloth(cloth); });
}

int ClothWorld::addObstacle(const ObstacleDescription& obstacle)
{
    return m_implementation->answer("addObstacle", -1, [&] { return m_implementation->addObstacle(obstacle); });
}

bool ClothWorld::removeCloth(int cloth)
{
    return m_implementation->answer("removeCloth", false,
                                    [&]
                                    {
                                        m_implementation->removeCloth(m_implementation->cloth(cloth));
                                        return true;
                                    });
}

bool ClothWorld::removeObstacle(int obstacle)
{
    Implementation& self = *m_implementation;
    return self.answer("removeObstacle", false,
                       [&]
                       {
                           self.obstacle(obstacle);
                           self.removeObstacle(self.m_obstacles[std::size_t(obstacle)]);
                           return true;
                       });
}

bool ClothWorld::setPose(int obstacle, const double position[3], const double rotation[4], bool teleport)
{
    Implementation& self = *m_implementation;
    return self.answer("setPose", false,
                       [&]
                       {
                           ObstacleBody& body = self.obstacle(obstacle);
                           requirePose(position, rotation);
                           body.setPose(position, rotation, teleport);
                           if (teleport) self.m_plugin.teleported(&body.body());
                           return true;
                       });
}

bool ClothWorld::setVertices(int obstacle, const float* positions, std::size_t vertexCount, bool teleport)
{
    Implementation& self = *m_implementation;
    return self.answer("setVertices", false,
                       [&]
                       {
                           ObstacleBody& body = self.obstacle(obstacle);
                           require(vertexCount == body.vertexCount(), "the obstacle has another number of vertices");
                           requireValues(positions, 3 * vertexCount, "positions");
                           body.setVertices(positions);
                           self.m_plugin.obstacleChanged(&body.shape());
                           if (teleport) self.m_plugin.teleported(&body.body());
                           return true;
                       });
}

bool ClothWorld::leaveOutTriangles(int obstacle, const std::int32_t* triangles, std::size_t count)
{
    Implementation& self = *m_implementation;
    const auto leaveOut = [&]
    {
        ObstacleBody& body = self.obstacle(obstacle);
        requireIndices(triangles, count, body.triangleCount(), "triangles", "triangle");
        TriangleFilter filter;
        if (count > 0)
        {
            std::vector<bool> collides(body.triangleCount(), true);
            for (std::size_t i = 0; i < count; ++i)
                collides[std::size_t(triangles[i])] = false;
            filter = [collides = std::move(collides)](int, int triangle) { return collides[std::size_t(triangle)]; };
        }
        self.m_plugin.setTriangleFilter(&body.shape(), std::move(filter));
        return true;
    };
    return self.answer("leaveOutTriangles", false, leaveOut);
}

bool ClothWorld::step(double dt)
{
    return m_implementation->answer("step", false,
                                    [&]
                                    {
                                        requireNumber(dt, 1e-9, 1e9, "dt should be above 0, s");
                                        m_implementation->noteBodies();
                                        // Without substeps: Bullet takes one step of this length.
                                        m_implementation->m_world.stepSimulation(btScalar(dt), 0);
                                        return true;
                                    });
}

std::string ClothWorld::diagnose() const
{
    return m_implementation->m_plugin.diagnose(m_implementation->m_world);
}

Plugin& ClothWorld::plugin()
{
    return m_implementation->m_plugin;
}

const Plugin& ClothWorld::plugin() const
{
    return m_implementation->m_plugin;
}

btSoftRigidDynamicsWorld& ClothWorld::world()
{
    return m_implementation->m_world;
}

std::shared_ptr<btSoftBody> ClothWorld::body(int cloth) const
{
    const bool isKnown = cloth >= 0 && std::size_t(cloth) < m_implementation->m_cloths.size();
    return isKnown ? m_implementation->m_cloths[std::size_t(cloth)].m_body : nullptr;
}
}  // namespace drape
