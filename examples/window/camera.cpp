#include "examples/window/camera.h"

#include <algorithm>
#include <cmath>

namespace drape::window
{
namespace
{
constexpr float kHalfHeight = 0.4142f;     // tangent of half of the field of view, 45 degrees
constexpr float kNear = 0.02f, kFar = 60;  // m

Matrix product(const Matrix& a, const Matrix& b)
{
    Matrix c = {};
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t k = 0; k < 4; ++k)
                c[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    return c;
}
}  // namespace

void Camera::turn(float yaw, float pitch)
{
    m_yaw += yaw;
    m_pitch = std::clamp(m_pitch + pitch, -1.5f, 1.5f);
}

void Camera::zoom(float factor)
{
    m_distance = std::clamp(m_distance * factor, 0.2f, 30.0f);
}

void Camera::pan(float right, float up)
{
    const btScalar height = btScalar(2 * kHalfHeight * m_distance);
    m_centre += this->right() * (height * right) + this->up() * (height * up);
}

void Camera::lookAt(const btVector3& low, const btVector3& high)
{
    m_centre = (low + high) / 2;
    m_distance = std::clamp(float((high - low).length()) * 0.95f, 0.5f, 20.0f);
}

btVector3 Camera::forward() const
{
    return btVector3(-std::cos(m_pitch) * std::sin(m_yaw), -std::sin(m_pitch), -std::cos(m_pitch) * std::cos(m_yaw));
}

btVector3 Camera::right() const
{
    return btVector3(std::cos(m_yaw), 0, -std::sin(m_yaw));
}

btVector3 Camera::eye() const
{
    return m_centre - forward() * m_distance;
}

Matrix Camera::viewProjection(float aspect) const
{
    const btVector3 axes[3] = {right(), up(), -forward()};
    Matrix view = {};
    for (std::size_t row = 0; row < 3; ++row)
    {
        for (std::size_t column = 0; column < 3; ++column)
            view[4 * column + row] = axes[row][int(column)];
        view[12 + row] = -axes[row].dot(eye());
    }
    view[15] = 1;
    const float depth = kNear - kFar;
    const Matrix projection = {
        1 / (aspect * kHalfHeight), 0, 0, 0, 0, 1 / kHalfHeight, 0, 0, 0, 0, (kFar + kNear) / depth, -1, 0, 0,
        2 * kFar * kNear / depth,   0};
    return product(projection, view);
}

Ray Camera::rayThrough(float x, float y, float aspect) const
{
    const btVector3 direction = forward() + right() * (x * aspect * kHalfHeight) + up() * (y * kHalfHeight);
    return {eye(), direction.normalized()};
}
}  // namespace drape::window
