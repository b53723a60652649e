// Worlds of cloth on NumPy arrays.
#include <array>

#include <pybind11/stl.h>

#include "bullet_plugin/adapter/c_api/field_lists.h"
#include "drape/cloth_world.h"
#include "python/binding/binding.h"

namespace drape
{
namespace
{
using Floats = Array<float>;
using Indices = Array<std::int32_t>;
using Vector = std::array<double, 3>;
using Rotation = std::array<double, 4>;

// Defaults of the arguments of add_cloth() and add_obstacle(), which Python's signatures repeat.
py::dict clothDefaults()
{
    const ClothDescription cloth = defaultCloth();
    py::dict found;
    found["mass"] = cloth.m_mass;
    found["thickness"] = cloth.m_thickness;
    found["stiffness"] = cloth.m_stiffness;
    found["bending_stiffness"] = cloth.m_bendingStiffness;
    found["friction"] = cloth.m_friction;
    found["damping"] = cloth.m_damping;
    found["iterations"] = cloth.m_iterations;
    found["self_collision"] = cloth.m_selfCollision != 0;
    return found;
}

py::dict obstacleDefaults()
{
    const ObstacleDescription obstacle = defaultObstacle();
    py::dict found;
    found["margin"] = obstacle.m_margin;
    found["friction"] = obstacle.m_friction;
    found["one_sided"] = obstacle.m_oneSided != 0;
    found["position"] = Vector{obstacle.m_position[0], obstacle.m_position[1], obstacle.m_position[2]};
    found["rotation"] =
        Rotation{obstacle.m_rotation[0], obstacle.m_rotation[1], obstacle.m_rotation[2], obstacle.m_rotation[3]};
    return found;
}

// Reads the arguments of add_cloth() that are numbers.
ClothDescription clothOf(const py::dict& options)
{
    ClothDescription cloth = defaultCloth();
    cloth.m_mass = valueOf<double>(options, "mass");
    cloth.m_thickness = valueOf<double>(options, "thickness");
    cloth.m_stiffness = valueOf<double>(options, "stiffness");
    cloth.m_bendingStiffness = valueOf<double>(options, "bending_stiffness");
    cloth.m_friction = valueOf<double>(options, "friction");
    cloth.m_damping = valueOf<double>(options, "damping");
    cloth.m_iterations = valueOf<int>(options, "iterations");
    cloth.m_selfCollision = valueOf<bool>(options, "self_collision");
    return cloth;
}

class PyWorld
{
public:
    explicit PyWorld(const py::dict& settings)
    {
        const Settings own = settingsOf(settings);
        Error error;
        {
            const py::gil_scoped_release released;
            m_world = ClothWorld::create(own, error);
        }
        if (!m_world) raise(error);
    }

    void setGravity(const Vector& gravity)
    {
        work([&] { return m_world->setGravity(gravity.data()); });
    }

    int addCloth(const Floats& positions, const Indices& triangles, const Indices& edges, const Floats& rest,
                 const Indices& pins, const Floats& masses, const py::dict& options)
    {
        ClothDescription cloth = clothOf(options);
        cloth.m_positions = dataOf(positions);
        cloth.m_vertexCount = std::size_t(positions.size()) / 3;
        cloth.m_triangles = dataOf(triangles);
        cloth.m_triangleCount = std::size_t(triangles.size()) / 3;
        cloth.m_edges = dataOf(edges);
        cloth.m_edgeCount = std::size_t(edges.size()) / 2;
        cloth.m_restPositions = dataOf(rest);
        cloth.m_pins = dataOf(pins);
        cloth.m_pinCount = std::size_t(pins.size());
        cloth.m_masses = dataOf(masses);
        return add([&] { return m_world->addCloth(cloth); });
    }

    int addObstacle(const Floats& positions, const Indices& triangles, const py::dict& options, const Vector& position,
                    const Rotation& rotation)
    {
        ObstacleDescription obstacle = defaultObstacle();
        obstacle.m_positions = dataOf(positions);
        obstacle.m_vertexCount = std::size_t(positions.size()) / 3;
        obstacle.m_triangles = dataOf(triangles);
        obstacle.m_triangleCount = std::size_t(triangles.size()) / 3;
        obstacle.m_margin = valueOf<double>(options, "margin");
        obstacle.m_friction = valueOf<double>(options, "friction");
        obstacle.m_oneSided = valueOf<bool>(options, "one_sided");
        std::copy(position.begin(), position.end(), obstacle.m_position);
        std::copy(rotation.begin(), rotation.end(), obstacle.m_rotation);
        return add([&] { return m_world->addObstacle(obstacle); });
    }

    void removeCloth(int cloth)
    {
        work([&] { return m_world->removeCloth(cloth); });
    }
    void removeObstacle(int obstacle)
    {
        work([&] { return m_world->removeObstacle(obstacle); });
    }
    void setPose(int obstacle, const Vector& position, const Rotation& rotation, bool teleport)
    {
        work([&] { return m_world->setPose(obstacle, position.data(), rotation.data(), teleport); });
    }
    void setVertices(int obstacle, const Floats& positions, bool teleport)
    {
        work([&]
             { return m_world->setVertices(obstacle, positions.data(), std::size_t(positions.size()) / 3, teleport); });
    }
    void leaveOutTriangles(int obstacle, const Indices& triangles)
    {
        work([&] { return m_world->leaveOutTriangles(obstacle, triangles.data(), std::size_t(triangles.size())); });
    }
    void setPinned(int cloth, const Indices& nodes, bool pinned)
    {
        work([&] { return m_world->setPinned(cloth, nodes.data(), std::size_t(nodes.size()), pinned); });
    }
    void setPositions(int cloth, const Indices& nodes, const Floats& positions, bool teleport)
    {
        work(
            [&] {
                return m_world->setPositions(cloth, nodes.data(), std::size_t(nodes.size()), positions.data(),
                                             teleport);
            });
    }
    void setVelocities(int cloth, const Indices& nodes, const Floats& velocities)
    {
        work([&] { return m_world->setVelocities(cloth, nodes.data(), std::size_t(nodes.size()), velocities.data()); });
    }
    // Returns the step's status.
    std::uint32_t step(double dt)
    {
        std::uint32_t status = kStepGood;
        work(
            [&]
            {
                if (!m_world->step(dt)) return false;
                status = m_world->plugin().statistics().m_status;
                return true;
            });
        return status;
    }

    // Returns views of positions, velocities and normals. They own a share of the body, so that it outlives them.
    py::tuple nodes(int cloth)
    {
        NodeView view = {};
        std::shared_ptr<btSoftBody> body;
        work(
            [&]
            {
                body = m_world->body(cloth);
                return m_world->nodes(cloth, view);
            });
        const py::dtype type = view.m_scalarBytes == 8 ? py::dtype::of<double>() : py::dtype::of<float>();
        const auto arrayOf = [&](const void* first)
        {
            const py::capsule owner(new std::shared_ptr<btSoftBody>(body),
                                    [](void* kept) { delete static_cast<std::shared_ptr<btSoftBody>*>(kept); });
            py::array found(type, {py::ssize_t(view.m_count), py::ssize_t(3)},
                            {py::ssize_t(view.m_strideBytes), py::ssize_t(view.m_scalarBytes)}, first, owner);
            found.attr("setflags")(py::arg("write") = false);
            return found;
        };
        return py::make_tuple(arrayOf(view.m_positions), arrayOf(view.m_velocities), arrayOf(view.m_normals));
    }

    py::array contacts()
    {
        std::vector<ClothContact> found;
        work([&] { return m_world->contacts(found); });
        return py::array_t<ClothContact>(py::ssize_t(found.size()), found.data());
    }
    void recordContacts(bool record)
    {
        m_turn.run([&] { m_world->plugin().recordContacts(record); });
    }
    py::array stepContacts()
    {
        std::vector<ClothStepContact> found;
        work([&] { return m_world->stepContacts(found); });
        return py::array_t<ClothStepContact>(py::ssize_t(found.size()), found.data());
    }
    py::array clothTriangles()
    {
        std::vector<ClothTriangles> found;
        work([&] { return m_world->clothTriangles(found); });
        return py::array_t<ClothTriangles>(py::ssize_t(found.size()), found.data());
    }

    py::dict statistics()
    {
        return dictOf(m_turn.run([&] { return m_world->plugin().statistics(); }));
    }
    py::dict device()
    {
        return dictOf(m_turn.run([&] { return m_world->plugin().device(); }));
    }
    void awaitDevice()
    {
        m_turn.run([&] { m_world->plugin().awaitDevice(); });
    }
    std::string report()
    {
        return m_turn.run([&] { return m_world->plugin().report(); });
    }
    std::string diagnose()
    {
        return m_turn.run([&] { return m_world->diagnose(); });
    }
    std::string deviceError()
    {
        return m_turn.run([&] { return m_world->plugin().error(); });
    }

private:
    // Calls the world in turn; raises its error if the call returns false.
    template <class Call>
    void work(const Call& call)
    {
        m_turn.run(
            [&]
            {
                if (!call()) raise(m_world->error());
            });
    }
    template <class Call>
    int add(const Call& call)
    {
        int index = -1;
        work(
            [&]
            {
                index = call();
                return index >= 0;
            });
        return index;
    }

    std::unique_ptr<ClothWorld> m_world;
    Turn m_turn;
};
}  // namespace

void bindWorld(py::module_& module)
{
    PYBIND11_NUMPY_DTYPE_EX(ClothContact, m_cloth, "cloth", m_obstacle, "obstacle", m_nodes, "nodes", m_weights,
                            "weights", m_normal, "normal", m_point, "point", m_gap, "gap", m_thickness, "thickness");
    PYBIND11_NUMPY_DTYPE_EX(ClothStepContact, m_cloth, "cloth", m_obstacle, "obstacle", m_triangle, "triangle", m_other,
                            "other", m_nodes, "nodes", m_otherNodes, "other_nodes", m_weights, "weights",
                            m_otherWeights, "other_weights", m_normal, "normal", m_point, "point", m_impulse, "impulse",
                            m_gap, "gap", m_thickness, "thickness", m_timeOfImpact, "time_of_impact");
    PYBIND11_NUMPY_DTYPE_EX(ClothTriangles, m_cloths, "cloths", m_nodes, "nodes");
    module.def("default_cloth", clothDefaults);
    module.def("default_obstacle", obstacleDefaults);
    py::class_<PyWorld>(module, "World")
        .def(py::init<const py::dict&>())
        .def("set_gravity", &PyWorld::setGravity)
        .def("add_cloth", &PyWorld::addCloth)
        .def("add_obstacle", &PyWorld::addObstacle)
        .def("remove_cloth", &PyWorld::removeCloth)
        .def("remove_obstacle", &PyWorld::removeObstacle)
        .def("set_pose", &PyWorld::setPose)
        .def("set_vertices", &PyWorld::setVertices)
        .def("leave_out_triangles", &PyWorld::leaveOutTriangles)
        .def("set_pinned", &PyWorld::setPinned)
        .def("set_positions", &PyWorld::setPositions)
        .def("set_velocities", &PyWorld::setVelocities)
        .def("step", &PyWorld::step)
        .def("nodes", &PyWorld::nodes)
        .def("contacts", &PyWorld::contacts)
        .def("record_contacts", &PyWorld::recordContacts)
        .def("step_contacts", &PyWorld::stepContacts)
        .def("cloth_triangles", &PyWorld::clothTriangles)
        .def("statistics", &PyWorld::statistics)
        .def("device", &PyWorld::device)
        .def("await_device", &PyWorld::awaitDevice)
        .def("report", &PyWorld::report)
        .def("diagnose", &PyWorld::diagnose)
        .def("device_error", &PyWorld::deviceError);
}
}  // namespace drape
