// A camera that orbits a point.
#pragma once

#include <array>

#include "LinearMath/btVector3.h"

namespace drape::window
{
using Matrix = std::array<float, 16>;  // by columns, as OpenGL takes it

struct Ray
{
    btVector3 m_from, m_direction;  // m, unit
};

class Camera
{
public:
    // Turns by radians.
    void turn(float yaw, float pitch);
    // Moves nearer (below 1) or farther.
    void zoom(float factor);
    // Moves the point along the picture's axes, as shares of the picture's height.
    void pan(float right, float up);
    // Shows the box, m.
    void lookAt(const btVector3& low, const btVector3& high);

    // aspect: width of the picture over its height.
    Matrix viewProjection(float aspect) const;
    btVector3 eye() const;
    // x, y: in the picture from -1 to 1, right and up.
    Ray rayThrough(float x, float y, float aspect) const;

private:
    btVector3 forward() const;
    btVector3 right() const;
    btVector3 up() const { return right().cross(forward()); }

    btVector3 m_centre = btVector3(0, btScalar(0.6), 0);
    float m_yaw = 0.6f, m_pitch = 0.38f, m_distance = 3.4f;
};
}  // namespace drape::window
