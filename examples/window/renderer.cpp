#include "examples/window/renderer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

namespace drape::window
{
namespace
{
constexpr const char* kMeshVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 viewProjection;
uniform bool shadow;
out vec3 place;
out vec3 direction;
void main()
{
    place = shadow ? vec3(position.x - 0.5 * position.y, 0.004, position.z - 0.389 * position.y) : position;
    direction = normal;
    gl_Position = viewProjection * vec4(place, 1);
}
)";

// Light from above and the sky's and the floor's, and a gleam.
constexpr const char* kMeshFragment = R"(#version 330 core
in vec3 place;
in vec3 direction;
uniform vec3 eye;
uniform vec3 front;
uniform vec3 back;
uniform float alpha;
uniform bool flat_;
uniform bool plain;
out vec4 result;
void main()
{
    if (plain) { result = vec4(front, alpha); return; }
    vec3 toEye = normalize(eye - place);
    vec3 n = normalize(flat_ ? cross(dFdx(place), dFdy(place)) : direction);
    bool isFront = dot(n, toEye) > 0;
    if (!isFront) n = -n;
    vec3 base = isFront ? front : back;
    vec3 light = normalize(vec3(0.45, 0.9, 0.35));
    float sun = max(dot(n, light), 0);
    vec3 sky = mix(vec3(0.30, 0.27, 0.25), vec3(0.52, 0.56, 0.62), 0.5 + 0.5 * n.y);
    float gleam = pow(max(dot(n, normalize(light + toEye)), 0), 40) * 0.18;
    float rim = pow(1 - abs(dot(n, toEye)), 3) * 0.12;
    vec3 colour = base * (sky + 0.75 * sun * vec3(1.0, 0.97, 0.9)) + gleam + rim;
    float haze = smoothstep(5.0, 14.0, length(eye - place));
    result = vec4(mix(pow(min(colour, vec3(1)), vec3(0.9)), vec3(0.80, 0.84, 0.90), haze), alpha);
}
)";

constexpr const char* kLineVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 colour;
uniform mat4 viewProjection;
out vec3 shade;
void main()
{
    shade = colour;
    gl_Position = viewProjection * vec4(position, 1);
    gl_Position.z -= 0.0004 * gl_Position.w;
}
)";

constexpr const char* kLineFragment = R"(#version 330 core
in vec3 shade;
out vec4 result;
void main() { result = vec4(shade, 1); }
)";

unsigned makeShader(unsigned kind, const char* text)
{
    const unsigned shader = glCreateShader(kind);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    int good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    char log[1024] = "";
    if (!good) glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    if (!good) throw std::runtime_error(std::string("a shader does not compile: ") + log);
    return shader;
}

unsigned makeProgram(const char* vertex, const char* fragment)
{
    const unsigned program = glCreateProgram();
    const unsigned shaders[2] = {makeShader(GL_VERTEX_SHADER, vertex), makeShader(GL_FRAGMENT_SHADER, fragment)};
    for (const unsigned shader : shaders)
        glAttachShader(program, shader);
    glLinkProgram(program);
    for (const unsigned shader : shaders)
        glDeleteShader(shader);
    int good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) throw std::runtime_error("a shader program does not link");
    return program;
}

// Sets two attributes of three floats each for the bound buffer.
void setAttributes()
{
    const int stride = 6 * sizeof(float);
    for (unsigned i = 0; i < 2; ++i)
    {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, stride, reinterpret_cast<const void*>(3 * i * sizeof(float)));
    }
}

template <class T>
void upload(unsigned target, unsigned buffer, const std::vector<T>& data)
{
    glBindBuffer(target, buffer);
    glBufferData(target, GLsizeiptr(data.size() * sizeof(T)), data.data(), GL_DYNAMIC_DRAW);
}

void setColour(unsigned program, const char* name, const Colour& colour)
{
    glUniform3f(glGetUniformLocation(program, name), colour.m_red, colour.m_green, colour.m_blue);
}
}  // namespace

GpuMesh::GpuMesh()
{
    glGenVertexArrays(1, &m_array);
    unsigned buffers[3];
    glGenBuffers(3, buffers);
    m_vertexBuffer = buffers[0];
    m_indexBuffer = buffers[1];
    m_edgeBuffer = buffers[2];
    glBindVertexArray(m_array);
    glBindBuffer(GL_ARRAY_BUFFER, m_vertexBuffer);
    setAttributes();
}

GpuMesh::~GpuMesh()
{
    const unsigned buffers[3] = {m_vertexBuffer, m_indexBuffer, m_edgeBuffer};
    glDeleteBuffers(3, buffers);
    glDeleteVertexArrays(1, &m_array);
}

void GpuMesh::setTriangles(const std::vector<std::int32_t>& triangles)
{
    m_triangles = triangles;
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
        const std::int32_t a = triangles[i], b = triangles[i % 3 == 2 ? i - 2 : i + 1];
        edges.emplace_back(std::min(a, b), std::max(a, b));
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    m_edges.clear();
    for (const auto& edge : edges)
        m_edges.insert(m_edges.end(), {edge.first, edge.second});
    glBindVertexArray(m_array);
    upload(GL_ELEMENT_ARRAY_BUFFER, m_edgeBuffer, m_edges);
    upload(GL_ELEMENT_ARRAY_BUFFER, m_indexBuffer, m_triangles);
}

void GpuMesh::setPositions(const float* positions, std::size_t vertices)
{
    m_vertices.assign(6 * vertices, 0);
    for (std::size_t i = 0; i < vertices; ++i)
        std::copy_n(positions + 3 * i, 3, m_vertices.begin() + std::ptrdiff_t(6 * i));
    for (std::size_t t = 0; t + 2 < m_triangles.size(); t += 3)
    {
        btVector3 corners[3];
        for (std::size_t k = 0; k < 3; ++k)
        {
            const float* const at = positions + 3 * std::size_t(m_triangles[t + k]);
            corners[k] = btVector3(at[0], at[1], at[2]);
        }
        const btVector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        for (std::size_t k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                m_vertices[6 * std::size_t(m_triangles[t + k]) + 3 + std::size_t(axis)] += float(normal[axis]);
    }
    upload(GL_ARRAY_BUFFER, m_vertexBuffer, m_vertices);
}

Renderer::Renderer()
    : m_meshProgram(makeProgram(kMeshVertex, kMeshFragment)), m_lineProgram(makeProgram(kLineVertex, kLineFragment))
{
    glGenVertexArrays(1, &m_lineArray);
    glGenBuffers(1, &m_lineBuffer);
    glBindVertexArray(m_lineArray);
    glBindBuffer(GL_ARRAY_BUFFER, m_lineBuffer);
    setAttributes();
}

Renderer::~Renderer()
{
    glDeleteBuffers(1, &m_lineBuffer);
    glDeleteVertexArrays(1, &m_lineArray);
    glDeleteProgram(m_meshProgram);
    glDeleteProgram(m_lineProgram);
}

void Renderer::begin(int width, int height, const Camera& camera)
{
    m_viewProjection = camera.viewProjection(float(width) / float(std::max(height, 1)));
    m_eye = camera.eye();
    glViewport(0, 0, width, height);
    glClearColor(0.80f, 0.84f, 0.90f, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_MULTISAMPLE);
    glDisable(GL_CULL_FACE);
}

void Renderer::draw(const GpuMesh& mesh, const Look& look)
{
    const auto uniform = [&](const char* name) { return glGetUniformLocation(m_meshProgram, name); };
    glUseProgram(m_meshProgram);
    glUniformMatrix4fv(uniform("viewProjection"), 1, GL_FALSE, m_viewProjection.data());
    glUniform3f(uniform("eye"), float(m_eye.x()), float(m_eye.y()), float(m_eye.z()));
    setColour(m_meshProgram, "front", look.m_front);
    setColour(m_meshProgram, "back", look.m_back);
    glUniform1f(uniform("alpha"), look.m_alpha);
    glUniform1i(uniform("flat_"), !look.m_smooth);
    glUniform1i(uniform("plain"), 0);
    glUniform1i(uniform("shadow"), 0);
    const bool blends = look.m_alpha < 1;
    if (blends)
    {
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
    }
    glBindVertexArray(mesh.m_array);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1, 1);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.m_indexBuffer);
    glDrawElements(GL_TRIANGLES, GLsizei(mesh.m_triangles.size()), GL_UNSIGNED_INT, nullptr);
    glDisable(GL_POLYGON_OFFSET_FILL);
    if (look.m_wires)
    {
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        setColour(m_meshProgram, "front", {0.08f, 0.12f, 0.25f});
        glUniform1f(uniform("alpha"), 0.35f);
        glUniform1i(uniform("plain"), 1);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.m_edgeBuffer);
        glDrawElements(GL_LINES, GLsizei(mesh.m_edges.size()), GL_UNSIGNED_INT, nullptr);
    }
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
}

void Renderer::drawShadow(const GpuMesh& mesh)
{
    const auto uniform = [&](const char* name) { return glGetUniformLocation(m_meshProgram, name); };
    glUseProgram(m_meshProgram);
    glUniformMatrix4fv(uniform("viewProjection"), 1, GL_FALSE, m_viewProjection.data());
    setColour(m_meshProgram, "front", {0.10f, 0.12f, 0.18f});
    glUniform1f(uniform("alpha"), 0.28f);
    glUniform1i(uniform("plain"), 1);
    glUniform1i(uniform("shadow"), 1);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glEnable(GL_STENCIL_TEST);  // each pixel is darkened once
    glStencilFunc(GL_EQUAL, 0, 255);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    glBindVertexArray(mesh.m_array);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.m_indexBuffer);
    glDrawElements(GL_TRIANGLES, GLsizei(mesh.m_triangles.size()), GL_UNSIGNED_INT, nullptr);
    glDisable(GL_STENCIL_TEST);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void Renderer::draw(const std::vector<ColouredPoint>& lines)
{
    if (lines.empty()) return;
    glUseProgram(m_lineProgram);
    glUniformMatrix4fv(glGetUniformLocation(m_lineProgram, "viewProjection"), 1, GL_FALSE, m_viewProjection.data());
    glBindVertexArray(m_lineArray);
    upload(GL_ARRAY_BUFFER, m_lineBuffer, lines);
    glDrawArrays(GL_LINES, 0, GLsizei(lines.size()));
}
}  // namespace drape::window
