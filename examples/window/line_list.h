// A drawer of Bullet's that collects lines, for drape::debugDraw().
#pragma once

#include <vector>

#include "LinearMath/btIDebugDraw.h"
#include "examples/window/renderer.h"

namespace drape::window
{
class LineList : public btIDebugDraw
{
public:
    using btIDebugDraw::drawLine;
    void drawLine(const btVector3& from, const btVector3& to, const btVector3& colour) override
    {
        for (const btVector3* const end : {&from, &to})
            m_points.push_back({{float(end->x()), float(end->y()), float(end->z())},
                                {float(colour.x()), float(colour.y()), float(colour.z())}});
    }
    void drawContactPoint(const btVector3& point, const btVector3& normal, btScalar distance, int,
                          const btVector3& colour) override
    {
        drawLine(point, point + normal * distance, colour);
    }
    void reportErrorWarning(const char*) override {}
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int) override {}
    int getDebugMode() const override { return DBG_DrawWireframe; }

    std::vector<ColouredPoint> m_points;
};
}  // namespace drape::window
