#include "tools/cloth_drop/scene_simulation.h"

#include "tools/cloth_drop/bullet_modes.h"
#include "tools/cloth_drop/drape_settings.h"
#include "tools/cloth_drop/plugin_simulation.h"
#include "tools/scene_world/scene_world.h"

namespace drape
{
namespace
{
ObstacleFrame frameOf(const btTransform& pose)
{
    ObstacleFrame frame;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            frame.m_axes[3 * row + column] = double(pose.getBasis()[row][column]);
    const btVector3& origin = pose.getOrigin();
    frame.m_origin = {double(origin.x()), double(origin.y()), double(origin.z())};
    return frame;
}

// A simulation whose step is a frame of the scene. Base: Simulation, or one of its classes.
template <typename Base>
class SceneSimulation : public Base
{
public:
    template <typename... Arguments>
    explicit SceneSimulation(const ClothScene& scene, const Arguments&... arguments)
        : Base(arguments...), m_scene(scene)
    {
    }

    StepTimes step() override
    {
        StepTimes all;
        for (int part = 0; part < m_scene.m_stepsPerFrame; ++part)
            add(m_world->step(m_scene.m_frameTime / m_scene.m_stepsPerFrame), all);
        return all;
    }
    const std::vector<float>& positions() override { return m_world->positions(); }
    const btCollisionWorld& world() override { return m_world->world(); }
    std::vector<ObstacleFrame> obstacleFrames() const override
    {
        std::vector<ObstacleFrame> frames;
        for (std::size_t i = 0; i < m_scene.m_obstacles.size(); ++i)
            frames.push_back(frameOf(m_world->obstaclePose(i)));
        return frames;
    }

protected:
    // Adds a step, which took stepMs.
    virtual void add(double stepMs, StepTimes& times) = 0;

    const ClothScene& m_scene;
    std::unique_ptr<SceneWorld> m_world;
};

class DrapeScene : public SceneSimulation<PluginSimulation>
{
public:
    DrapeScene(const ClothScene& scene, const Settings& settings) : SceneSimulation(scene, settings)
    {
        m_world = std::make_unique<SceneWorld>(scene, *m_plugin);
        prepare(m_world->world());
    }

private:
    void add(double stepMs, StepTimes& times) override
    {
        addStep(stepMs, m_world->world().collisionMs(), m_world->solverMs(), times);
        times.m_contacts += m_plugin->statistics().m_selfContacts;
    }
    const btSoftBody& firstCloth() const override { return m_world->cloth(0); }
};

class BulletScene : public SceneSimulation<Simulation>
{
public:
    BulletScene(const ClothScene& scene, BulletMode mode) : SceneSimulation(scene), m_mode(mode)
    {
        m_world = std::make_unique<SceneWorld>(scene, BulletCollision::Clusters);
        if (mode == BulletMode::Tuned) tuneField(m_world->world().getWorldInfo());
    }

    std::string backend() const override { return m_mode == BulletMode::Tuned ? "bullet (tuned)" : "bullet (stock)"; }
    std::string device() const override { return "host"; }
    std::string deviceReason() const override { return "Bullet's own collision runs on the host"; }
    double prepareMs() const override { return 0; }
    std::string trouble() const override { return ""; }

private:
    void add(double stepMs, StepTimes& times) override
    {
        times.m_stepMs += stepMs;
        times.m_collisionMs += m_world->world().collisionMs();
        times.m_contacts = 0;
        for (std::size_t i = 0; i < m_world->clothCount(); ++i)
        {
            const btSoftBody& cloth = m_world->cloth(i);
            times.m_contacts += std::size_t(cloth.m_rcontacts.size()) + std::size_t(cloth.m_scontacts.size());
        }
    }

    BulletMode m_mode;
};

bool anyMoves(const ClothScene& scene)
{
    for (const SceneObstacle& obstacle : scene.m_obstacles)
        if (obstacle.m_mass > 0 || (obstacle.m_moves && obstacle.m_poseAt)) return true;
    return false;
}
}  // namespace

RunSubject subjectOf(const ClothScene& scene)
{
    RunSubject subject;
    bool self = false;
    for (const SceneCloth& cloth : scene.m_cloths)
    {
        const auto first = std::int32_t(subject.m_cloths.vertexCount());
        for (const std::int32_t node : cloth.m_rest.m_mesh.m_triangles)
            subject.m_cloths.m_triangles.push_back(first + node);
        for (const std::int32_t node : cloth.lines())
            subject.m_lines.push_back(first + node);
        subject.m_cloths.m_positions.insert(subject.m_cloths.m_positions.end(), cloth.m_positions.begin(),
                                            cloth.m_positions.end());
        const std::vector<float>& rest = cloth.m_restsAtStart ? cloth.m_positions : cloth.m_rest.m_mesh.m_positions;
        subject.m_rest.insert(subject.m_rest.end(), rest.begin(), rest.end());
        for (const SceneAnchors& anchors : cloth.m_anchors)
            if (!anchors.m_collides)
                subject.m_passing.push_back({anchors.m_obstacle, std::size_t(first), subject.m_cloths.vertexCount()});
        self = self || cloth.m_selfCollides;
    }
    for (const SceneObstacle& obstacle : scene.m_obstacles)
    {
        subject.m_names.push_back(obstacle.m_name);
        subject.m_obstacles.push_back(obstacle.m_mesh);
        subject.m_starts.push_back(frameOf(poseOf(obstacle, 0)));
        subject.m_isShown.push_back(obstacle.m_shape.m_kind != ObstacleShape::Kind::Plane);
    }
    for (const SceneCloth& cloth : scene.m_cloths)
        subject.m_names.push_back(cloth.m_name);
    subject.m_obstaclesMove = anyMoves(scene);
    subject.m_thickness = scene.m_thickness;
    subject.m_dt = scene.m_frameTime;
    subject.m_countsClothPairs = self || scene.m_cloths.size() > 1;
    return subject;
}

std::unique_ptr<Simulation> makeDrapeScene(const ClothScene& scene, const Options& options, std::string& error,
                                           int& exitCode)
{
    Settings settings;
    exitCode = kExitBadInput;
    if (!drapeSettings(options, settings, error)) return nullptr;
    settings.m_nameOf = [&scene](const btCollisionObject& body) { return nameOf(scene, body); };
    auto simulation = std::make_unique<DrapeScene>(scene, settings);
    if (!isReady(simulation->plugin(), error, exitCode)) return nullptr;
    return simulation;
}

std::unique_ptr<Simulation> makeBulletScene(const ClothScene& scene, BulletMode mode)
{
    return std::make_unique<BulletScene>(scene, mode);
}
}  // namespace drape
