// Runs Bullet's own solver for a body, one of its iterations at a time, so that contacts are solved in between.
#pragma once

#include "bullet_plugin/core/solver/solver_cloth.h"

class btSoftBody;

namespace drape
{
// Runs Bullet's own solver for the body, in the floating-point environment of the app.
void solveByBullet(btSoftBody& body);

class BulletLinks : public CallersLinks
{
public:
    // Minimum iterations of Bullet for a body with contacts whose iterations can be run one by one. The error left by a
    // single pass over links and contacts becomes velocity. Where the pass overshoots, the next step corrects it and
    // overshoots on the other side. A cloth of 33 x 33 nodes on a sphere keeps moving at 600 mm/s with one pass, at 2
    // mm/s with two.
    static constexpr int kLeastIterations = 2;

    BulletLinks(btSoftBody& body, bool hasContacts) : m_body(&body), m_hasContacts(hasContacts) {}

    int iterations() const override;
    void solve(int iteration) override;
    void read(SolverNodes& nodes) override;
    void write(const SolverNodes& nodes) override;
    // Returns the time of Bullet's part, ms.
    double ms() const { return m_ms; }

private:
    int positionIterations() const;

    btSoftBody* m_body;
    bool m_hasContacts;
    double m_ms = 0;
};
}  // namespace drape
