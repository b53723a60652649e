// Draws meshes with light and wires, and coloured lines, with OpenGL 3.3.
//
// Make it with a current context. Positions are x y z per vertex, m, y up. Output: the frame buffer that is bound.
#pragma once

#include <cstdint>
#include <vector>

#include "examples/window/camera.h"
#include "scenes/mesh.h"

namespace drape::window
{
struct Colour
{
    float m_red, m_green, m_blue;
};

struct ColouredPoint
{
    float m_position[3], m_colour[3];
};

// The colours and the manner in which a mesh is drawn.
struct Look
{
    Colour m_front, m_back;
    float m_alpha = 1;  // below 1: what is behind shines through
    bool m_wires = false;
    bool m_smooth = true;  // normals are those of vertices, else of triangles
};

// A mesh in the graphics memory.
class GpuMesh
{
public:
    GpuMesh();
    ~GpuMesh();
    GpuMesh(const GpuMesh&) = delete;
    GpuMesh& operator=(const GpuMesh&) = delete;

    void setTriangles(const std::vector<std::int32_t>& triangles);
    // Sets the vertices, and computes their normals.
    void setPositions(const float* positions, std::size_t vertices);

private:
    friend class Renderer;

    std::vector<std::int32_t> m_triangles;
    std::vector<std::int32_t> m_edges;  // 2 nodes each
    std::vector<float> m_vertices;      // position and normal
    unsigned m_array = 0, m_vertexBuffer = 0, m_indexBuffer = 0, m_edgeBuffer = 0;
};

class Renderer
{
public:
    Renderer();
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Begins a picture of so many pixels: clears it.
    void begin(int width, int height, const Camera& camera);
    void draw(const GpuMesh& mesh, const Look& look);
    // Draws the shadow of a mesh on the floor, y = 0, which must have been drawn.
    void drawShadow(const GpuMesh& mesh);
    // Draws lines where no mesh before is in front of them.
    void draw(const std::vector<ColouredPoint>& lines);

private:
    unsigned m_meshProgram = 0, m_lineProgram = 0, m_lineArray = 0, m_lineBuffer = 0;
    Matrix m_viewProjection = {};
    btVector3 m_eye;
};
}  // namespace drape::window
