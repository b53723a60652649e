// drape_window: cloth with Drape, or with Bullet's own collision, in a window. The mouse turns the camera and drags
// cloth; the panel shows contacts, times and what the last step did (docs/seeing_contacts.md).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <GL/gl.h>

#include "drape/debug_draw.h"
#include "examples/window/line_list.h"
#include "examples/window/options.h"
#include "examples/window/panel.h"
#include "examples/window/renderer.h"
#include "examples/window/simulation.h"
#include "examples/window/window_scenes.h"
#include "scenes/cloth_rope.h"
#include "tools/cloth_drop/image.h"
#include "tools/common/arguments.h"
#include "tools/common/device_option.h"
#include "tools/scene_file/built_in_scene.h"

namespace drape::window
{
namespace
{
constexpr float kGrabbed = 0.05f;           // share of the picture's height within which the mouse takes a node
constexpr double kLeastRopeRadius = 0.003;  // m

// The window, with an OpenGL context that is current.
class Window
{
public:
    Window(int width, int height)
    {
        glfwSetErrorCallback([](int, const char* text) { std::fprintf(stderr, "drape_window: %s\n", text); });
        if (!glfwInit()) throw std::runtime_error("no display: DISPLAY names none that can be opened");
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_SAMPLES, 4);
        m_window = glfwCreateWindow(width, height, "Drape", nullptr, nullptr);
        if (!m_window)
        {
            glfwTerminate();
            throw std::runtime_error("no window with OpenGL 3.3 can be opened");
        }
        glfwMakeContextCurrent(m_window);
        glfwSwapInterval(1);
        ImGui::CreateContext();
        styleAsPanel();
        ImGui_ImplGlfw_InitForOpenGL(m_window, true);
        ImGui_ImplOpenGL3_Init("#version 330");
    }
    ~Window()
    {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
        glfwDestroyWindow(m_window);
        glfwTerminate();
    }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* get() const { return m_window; }

private:
    GLFWwindow* m_window = nullptr;
};

class App
{
public:
    App(const Options& options, const Settings& settings)
        : m_options(options), m_simulation(settings), m_window(options.m_width, options.m_height)
    {
        m_choices.m_scene = options.m_scene;
        m_choices.m_byBullet = options.m_bullet;
        m_choices.m_draws = options.m_draws;
    }

    // Starts the chosen scene. Returns false, with the reason in the choices, if it cannot be made.
    bool start()
    {
        ClothScene scene;
        m_choices.m_restarts = false;
        if (!makeWindowScene(m_choices.m_scene, m_options.m_detail, m_options.m_models, scene, m_choices.m_error))
            return false;
        m_choices.m_error.clear();
        const bool isOther = scene.m_name != m_simulation.scene().m_name;
        m_simulation.start(scene, m_choices.m_byBullet);
        takeMeshes();
        if (isOther) lookAtCloth();
        return true;
    }
    const std::string& error() const { return m_choices.m_error; }

    // Shows frames until the window is closed or the options' number is reached.
    void run()
    {
        for (int frame = 0; !glfwWindowShouldClose(m_window.get()); ++frame)
        {
            if (m_options.m_frames > 0 && frame == m_options.m_frames) break;
            glfwPollEvents();
            ImGui_ImplOpenGL3_NewFrame();
            ImGui_ImplGlfw_NewFrame();
            ImGui::NewFrame();
            drawPanel(m_simulation, m_choices);
            takeInput();
            if (m_choices.m_restarts) start();
            if (!m_choices.m_isPaused || m_choices.m_stepsOnce) m_simulation.step(m_choices.m_draws != 0);
            m_choices.m_stepsOnce = false;
            draw();
            if (frame + 1 != m_options.m_frames) glfwSwapBuffers(m_window.get());
        }
    }
    // Returns the picture that was drawn last.
    Image picture() const
    {
        int width = 0, height = 0;
        glfwGetFramebufferSize(m_window.get(), &width, &height);
        Image image(width, height);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        for (int row = 0; row < height; ++row)
            glReadPixels(0, row, width, 1, GL_RGB, GL_UNSIGNED_BYTE, image.at(0, height - 1 - row));
        return image;
    }

private:
    void takeMeshes()
    {
        m_cloth = std::make_unique<GpuMesh>();
        m_cloth->setTriangles(m_simulation.world().mesh().m_triangles);
        m_ropes = std::make_unique<GpuMesh>();
        m_lines = m_simulation.world().lines();
        m_obstacles.clear();
        for (const SceneObstacle& obstacle : m_simulation.scene().m_obstacles)
        {
            m_obstacles.push_back(std::make_unique<GpuMesh>());
            m_obstacles.back()->setTriangles(obstacle.m_mesh.m_triangles);
        }
        placeObstacles();
    }
    void placeObstacles()
    {
        std::vector<float> positions;
        m_simulation.world().addObstaclePositions(positions);
        const float* at = positions.data();
        for (std::size_t i = 0; i < m_obstacles.size(); ++i)
        {
            const std::size_t count = m_simulation.scene().m_obstacles[i].m_mesh.m_positions.size();
            m_obstacles[i]->setPositions(at, count / 3);
            at += count;
        }
    }
    void placeRopes(const std::vector<float>& nodes)
    {
        const double radius = std::max(kLeastRopeRadius, 0.5 * m_simulation.scene().m_thickness);
        const TriangleMesh tubes = tubesAround(nodes, m_lines, radius);
        m_ropes->setTriangles(tubes.m_triangles);
        m_ropes->setPositions(tubes.m_positions.data(), tubes.vertexCount());
    }
    void lookAtCloth()
    {
        btVector3 low(1, 1, 1), high(-1, -1, -1);
        for (std::size_t i = 0; i < m_simulation.scene().m_cloths.size(); ++i)
        {
            btVector3 from, to;
            m_simulation.world().cloth(i).getAabb(from, to);
            if (i == 0) low = from, high = to;
            low.setMin(from);
            high.setMax(to);
        }
        // Shows the obstacle below, too.
        low.setY(std::min(low.y() - btScalar(0.5) * (high.x() - low.x()), btScalar(0.2)));
        m_camera.lookAt(low, high);
    }

    // Returns whether the key went down since the last frame. wasDown: its state then, which becomes the present one.
    bool isPressed(int key, bool& wasDown) const
    {
        const bool isDown = glfwGetKey(m_window.get(), key) == GLFW_PRESS, pressed = isDown && !wasDown;
        wasDown = isDown;
        return pressed;
    }
    // Takes the mouse and the keys that the panel does not take.
    void takeInput()
    {
        const ImGuiIO& io = ImGui::GetIO();
        if (!io.WantCaptureKeyboard)
        {
            if (isPressed(GLFW_KEY_SPACE, m_keys[0])) m_choices.m_isPaused = !m_choices.m_isPaused;
            if (isPressed(GLFW_KEY_S, m_keys[1])) m_choices.m_isPaused = m_choices.m_stepsOnce = true;
            if (isPressed(GLFW_KEY_R, m_keys[2])) m_choices.m_restarts = true;
        }
        if (!ImGui::IsMouseDown(0)) m_simulation.m_held = Held();
        if (io.WantCaptureMouse) return;
        const float height = std::max(io.DisplaySize.y, 1.0f), aspect = io.DisplaySize.x / height;
        if (io.MouseWheel != 0) m_camera.zoom(std::pow(0.9f, io.MouseWheel));
        if (ImGui::IsMouseDown(1) || ImGui::IsMouseDown(2))
            m_camera.pan(-io.MouseDelta.x / height, io.MouseDelta.y / height);
        const Ray ray = m_camera.rayThrough(2 * io.MousePos.x / std::max(io.DisplaySize.x, 1.0f) - 1,
                                            1 - 2 * io.MousePos.y / height, aspect);
        if (ImGui::IsMouseClicked(0)) grab(ray);
        if (m_simulation.m_held.any())
            m_simulation.m_held.m_target = ray.m_from + ray.m_direction * m_grabDistance;
        else if (ImGui::IsMouseDown(0))
            m_camera.turn(-io.MouseDelta.x * 0.006f, io.MouseDelta.y * 0.006f);
    }
    // Takes the node that is nearest to the camera among those near the ray.
    void grab(const Ray& ray)
    {
        btScalar nearest = BT_LARGE_FLOAT;
        for (std::size_t i = 0; i < m_simulation.scene().m_cloths.size(); ++i)
        {
            const btSoftBody& body = m_simulation.world().cloth(i);
            for (int node = 0; node < body.m_nodes.size(); ++node)
            {
                const btVector3 way = body.m_nodes[node].m_x - ray.m_from;
                const btScalar along = way.dot(ray.m_direction);
                const btScalar aside = (way - ray.m_direction * along).length();
                if (along <= 0 || along > nearest || aside > btScalar(kGrabbed) * along) continue;
                // A node that is a little farther but nearer to the ray is meant.
                if (along + 4 * aside > nearest) continue;
                nearest = along + 4 * aside;
                m_grabDistance = along;
                m_simulation.m_held = {int(i), node, body.m_nodes[node].m_x};
            }
        }
    }

    // Draws the obstacles, and shadows on the floor if there is one.
    void drawObstacles()
    {
        const std::size_t floor = hasFloor(m_choices.m_scene) ? m_obstacles.size() - 1 : m_obstacles.size();
        if (floor < m_obstacles.size())
        {
            m_renderer->draw(*m_obstacles[floor], {{0.56f, 0.60f, 0.66f}, {0.4f, 0.4f, 0.4f}, 1, false, false});
            m_renderer->drawShadow(*m_cloth);
            m_renderer->drawShadow(*m_ropes);
        }
        for (std::size_t i = 0; i < floor; ++i)
        {
            if (floor < m_obstacles.size()) m_renderer->drawShadow(*m_obstacles[i]);
            m_renderer->draw(*m_obstacles[i], {{0.74f, 0.66f, 0.56f}, {0.45f, 0.40f, 0.38f}, 1, false, true});
        }
    }

    void draw()
    {
        int width = 0, height = 0;
        glfwGetFramebufferSize(m_window.get(), &width, &height);
        if (!m_renderer) m_renderer = std::make_unique<Renderer>();
        const std::vector<SceneObstacle>& obstacles = m_simulation.scene().m_obstacles;
        if (std::any_of(obstacles.begin(), obstacles.end(), [](const SceneObstacle& one) { return one.m_poseAt; }))
            placeObstacles();
        const std::vector<float>& nodes = m_simulation.world().positions();
        m_cloth->setPositions(nodes.data(), nodes.size() / 3);
        placeRopes(nodes);
        LineList lines;
        if (!m_simulation.isByBullet()) debugDraw(m_simulation.plugin(), lines, m_choices.m_draws);
        if (m_simulation.m_held.any())
        {
            const btSoftBody& body = m_simulation.world().cloth(std::size_t(m_simulation.m_held.m_cloth));
            lines.drawLine(body.m_nodes[m_simulation.m_held.m_node].m_x, m_simulation.m_held.m_target,
                           btVector3(1, btScalar(0.3), btScalar(0.1)));
        }
        m_renderer->begin(width, height, m_camera);
        drawObstacles();
        const bool seesThrough = !lines.m_points.empty();
        if (seesThrough) m_renderer->draw(lines.m_points);
        m_renderer->draw(
            *m_cloth,
            {{0.27f, 0.47f, 0.85f}, {0.87f, 0.55f, 0.28f}, seesThrough ? 0.35f : 1.0f, m_choices.m_wires, true});
        m_renderer->draw(*m_ropes, {{0.27f, 0.47f, 0.85f}, {0.27f, 0.47f, 0.85f}, 1, false, true});
        ImGui::Render();
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    }

    const Options& m_options;
    Simulation m_simulation;
    Window m_window;
    Choices m_choices;
    Camera m_camera;
    std::unique_ptr<Renderer> m_renderer;  // it and the meshes go before the window
    std::unique_ptr<GpuMesh> m_cloth, m_ropes;
    std::vector<std::int32_t> m_lines;                  // links of ropes, two nodes each
    std::vector<std::unique_ptr<GpuMesh>> m_obstacles;  // in the scene's order
    btScalar m_grabDistance = 1;                        // m, from the camera
    bool m_keys[3] = {};                                // see isPressed()
};

int show(const Options& options)
{
    if (options.m_listScenes)
    {
        for (const std::string& name : windowSceneNames())
            std::puts(name.c_str());
        return kExitGood;
    }
    Settings settings;
    std::string error;
    if (!deviceSettings(options.m_backend, options.m_device, settings, error) ||
        !couldWrite(options.m_screenshot, error))
        return fail("drape_window", kExitBadInput, error);
    SceneFile file;  // mistakes in it are told without a display
    const bool isFile = !isWindowScene(options.m_scene) && isSceneFile(options.m_scene);
    if (isFile && !readScene(options.m_scene, file, error)) return fail("drape_window", kExitBadInput, error);
    App app(options, settings);
    if (!app.start()) return fail("drape_window", kExitBadInput, app.error());
    app.run();
    if (options.m_screenshot.empty() || writePng(options.m_screenshot, app.picture(), error)) return kExitGood;
    return fail("drape_window", kExitFailed, error);
}
}  // namespace
}  // namespace drape::window

int main(int argc, char** argv)
{
    return drape::runProgram<drape::window::Options>("drape_window", argc, argv, drape::window::parse,
                                                     drape::window::show);
}
