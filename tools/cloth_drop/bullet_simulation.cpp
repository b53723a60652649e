#include "tools/cloth_drop/bullet_modes.h"
#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/simulation.h"

namespace drape
{
namespace
{
class BulletSimulation : public Simulation
{
public:
    BulletSimulation(const DropScene& scene, BulletMode mode)
        : m_world(std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>(), nullptr),
          m_mode(mode),
          m_dt(scene.m_dt)
    {
        if (mode == BulletMode::Tuned) tuneField(m_world.world().getWorldInfo());
        if (mode == BulletMode::SoftPair)
            m_world.addSoftObstacle(scene);
        else
            m_world.addMeshObstacle(scene);
        m_world.addCloths(scene, mode == BulletMode::SoftPair);
        if (scene.m_self) m_world.useBulletsClothWithCloth();
    }

    StepTimes step() override
    {
        StepTimes times;
        times.m_stepMs = m_world.step(m_dt);
        times.m_collisionMs = m_world.world().collisionMs();
        const btSoftBody& cloth = m_world.cloth();
        times.m_contacts =
            static_cast<std::size_t>(cloth.m_rcontacts.size()) + static_cast<std::size_t>(cloth.m_scontacts.size());
        return times;
    }

    const std::vector<float>& positions() override { return m_world.positions(); }
    const btCollisionWorld& world() override { return m_world.world(); }
    std::string backend() const override
    {
        return m_mode == BulletMode::Stock   ? "bullet (stock)"
               : m_mode == BulletMode::Tuned ? "bullet (tuned)"
                                             : "bullet (vfss)";
    }
    std::string device() const override { return "host"; }
    std::string deviceReason() const override { return "Bullet's own collision runs on the host"; }
    double prepareMs() const override { return 0; }
    std::string trouble() const override { return ""; }

private:
    DropWorld m_world;
    BulletMode m_mode;
    double m_dt;
};
}  // namespace

std::unique_ptr<Simulation> makeBulletSimulation(const DropScene& scene, BulletMode mode)
{
    return std::make_unique<BulletSimulation>(scene, mode);
}
}  // namespace drape
