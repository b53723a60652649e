#include "benchmarks/error_vs_time/trial_simulation.h"

#include <cmath>

#include <drape/drape.h>

#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/node_positions.h"
#include "oracle/crossings.h"

namespace drape::bench
{
namespace
{
// The field has enough cells, so that none is thrown away.
constexpr int kFieldHashSize = 1048573;
constexpr int kFieldCells = 16000000;

class WorldSimulation : public TrialSimulation
{
public:
    // `plugin` is null for Bullet's own collision.
    WorldSimulation(const ErrorScene& scene, const Trial& trial, std::unique_ptr<Plugin> plugin)
        : m_plugin(std::move(plugin)),
          m_world(makeConfiguration(m_plugin.get()), makeSolver(m_plugin.get())),
          m_crossings(scene.m_drop.m_obstacle, scene.m_drop.m_cloth.m_mesh.m_positions),
          m_trial(trial),
          m_rise(scene.m_rise),
          m_dt(scene.m_drop.m_dt)
    {
        if (trial.m_voxel > 0) setVoxel(trial.m_voxel);
        if (m_rise != 0)
            m_moving = &m_world.addMovingObstacle(scene.m_drop);
        else
            m_world.addMeshObstacle(scene.m_drop);
        m_world.addCloth(scene.m_drop, false);
        btSoftBody& cloth = m_world.cloth();
        cloth.m_cfg.piterations = trial.m_iterations;
        // Air drag is a share of the speed per step. The factor gives the same share per second for any time step.
        cloth.m_cfg.kDP = btScalar(1 - std::pow(1 - double(cloth.m_cfg.kDP), 1.0 / trial.m_substeps));
    }

    StepTimes step() override
    {
        StepTimes times;
        if (m_moving) moveObstacle();
        times.m_stepMs = m_world.step(m_dt);
        times.m_collisionMs = m_world.world().collisionMs();
        const btSoftBody& cloth = m_world.cloth();
        times.m_contacts = std::size_t(cloth.m_rcontacts.size()) + std::size_t(cloth.m_scontacts.size());
        if (m_plugin)
        {
            times.m_collisionMs += m_plugin->statistics().collisionMs();
            times.m_contacts = m_plugin->statistics().m_contacts;
            m_status |= m_plugin->statistics().m_status;
        }
        weigh(cloth);
        return times;
    }

    // Called once after each step, outside of its time.
    const std::vector<float>& positions() override
    {
        copyPositions(m_world.cloth(), m_positions);
        if (m_moving)
        {
            const float height = float(m_moving->getWorldTransform().getOrigin().y());
            for (std::size_t i = 1; i < m_positions.size(); i += 3)
                m_positions[i] -= height;
        }
        m_crossings.follow(m_positions);
        return m_positions;
    }
    const btCollisionWorld& world() override { return m_world.world(); }
    std::string backend() const override { return m_trial.method(); }
    std::string device() const override { return m_plugin ? m_plugin->device().m_device.m_name : "host"; }
    std::string deviceReason() const override { return m_plugin ? m_plugin->device().m_reason : ""; }
    double prepareMs() const override { return m_plugin ? m_plugin->device().m_buildMs : 0; }
    std::string trouble() const override { return m_status == kStepGood ? "" : "status " + std::to_string(m_status); }
    const std::vector<double>& speeds() const override { return m_speeds; }
    const std::vector<ClothEnergy>& energies() const override { return m_energies; }
    std::size_t crossed() const override { return m_crossings.nodes(); }

private:
    static std::unique_ptr<btCollisionConfiguration> makeConfiguration(Plugin* plugin)
    {
        if (plugin) return std::make_unique<CollisionConfiguration>(*plugin);
        return std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>();
    }
    static std::unique_ptr<btSoftBodySolver> makeSolver(Plugin* plugin)
    {
        if (plugin) return std::make_unique<SoftBodySolver>(*plugin);
        return nullptr;
    }

    void setVoxel(double size)
    {
        auto& field = m_world.world().getWorldInfo().m_sparsesdf;
        field.Initialize(kFieldHashSize, kFieldCells);
        field.setDefaultVoxelsz(btScalar(size));
        field.Reset();  // only now the voxel size counts
    }

    // Moves the obstacle from the end of the last step to the end of this one.
    void moveObstacle()
    {
        m_height += m_rise * m_dt;
        m_moving->setWorldTransform(btTransform(btMatrix3x3::getIdentity(), btVector3(0, btScalar(m_height), 0)));
    }

    double linkEnergy(const btSoftBody& cloth) const
    {
        double energy = 0;
        for (int i = 0; i < cloth.m_links.size(); ++i)
        {
            const btSoftBody::Link& link = cloth.m_links[i];
            const double inverseMass = double(link.m_n[0]->m_im) + double(link.m_n[1]->m_im);
            if (!(inverseMass > 0)) continue;
            const double stretch = double((link.m_n[0]->m_x - link.m_n[1]->m_x).length()) - double(link.m_rl);
            const double share = 1 - std::pow(1 - double(link.m_material->m_kLST), m_trial.m_iterations);
            const double speed = share * stretch / m_dt;
            energy += 0.5 * speed * speed / inverseMass;
        }
        return energy;
    }

    void weigh(const btSoftBody& cloth)
    {
        ClothEnergy energy;
        energy.m_links = linkEnergy(cloth);
        double squares = 0;
        for (int i = 0; i < cloth.m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = cloth.m_nodes[i];
            const double mass = node.m_im > 0 ? 1 / double(node.m_im) : 0, square = double(node.m_v.length2());
            squares += double((node.m_v - btVector3(0, btScalar(m_rise), 0)).length2());
            energy.m_motion += mass * (0.5 * square + 9.81 * double(node.m_x.y()));
        }
        m_speeds.push_back(std::sqrt(squares / cloth.m_nodes.size()));
        m_energies.push_back(energy);
    }

    std::unique_ptr<Plugin> m_plugin;  // before the world: it must outlive the configuration's users
    DropWorld m_world;
    Crossings m_crossings;
    Trial m_trial;
    double m_rise;  // m/s
    double m_dt;
    btRigidBody* m_moving = nullptr;  // the obstacle, where it moves
    double m_height = 0;              // m, of it above its start
    std::uint32_t m_status = 0;
    std::vector<float> m_positions;
    std::vector<double> m_speeds;
    std::vector<ClothEnergy> m_energies;
};
}  // namespace

ErrorScene sceneOf(const ErrorScene& scene, const Trial& trial)
{
    ErrorScene own = scene;
    if (trial.m_seed != 0) varyFall(own, trial.m_seed);
    own.m_drop.m_thickness = trial.m_thickness;
    own.m_drop.m_dt = kFrameTime / trial.m_substeps;
    return own;
}

std::unique_ptr<TrialSimulation> makeTrialSimulation(const ErrorScene& scene, const Trial& trial, Settings settings,
                                                     std::string& error)
{
    if (!trial.isDrape()) return std::make_unique<WorldSimulation>(scene, trial, nullptr);
    settings.m_activation = float(trial.m_activation);
    settings.m_mode = trial.m_mode;
    if (trial.m_method == Method::DrapeHost)
    {
        settings.m_backend = Backend::Host;
        settings.m_device.clear();
    }
    auto plugin = std::make_unique<Plugin>(settings);
    error = plugin->ready() ? "" : plugin->error();
    if (!error.empty()) return nullptr;
    return std::make_unique<WorldSimulation>(scene, trial, std::move(plugin));
}
}  // namespace drape::bench
