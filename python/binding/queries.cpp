// Collision queries on NumPy arrays.
#include "drape/queries.h"

#include "bullet_plugin/adapter/c_api/field_count.h"
#include "python/binding/binding.h"

namespace drape
{
namespace
{
using Floats = Array<float>;
using Indices = Array<std::int32_t>;

MeshDescription meshOf(const Floats& positions, const Indices& triangles, const Indices& edges)
{
    MeshDescription mesh;
    mesh.m_positions = dataOf(positions);
    mesh.m_vertexCount = std::size_t(positions.size()) / 3;
    mesh.m_triangles = dataOf(triangles);
    mesh.m_triangleCount = std::size_t(triangles.size()) / 3;
    mesh.m_edges = dataOf(edges);
    mesh.m_edgeCount = std::size_t(edges.size()) / 2;
    return mesh;
}

py::array pairsOf(const std::vector<NearTriangles>& pairs)
{
    py::array_t<std::uint32_t> found({py::ssize_t(pairs.size()), py::ssize_t(2)});
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        found.mutable_at(py::ssize_t(i), 0) = pairs[i].m_a;
        found.mutable_at(py::ssize_t(i), 1) = pairs[i].m_b;
    }
    return found;
}

class PyQueries
{
public:
    explicit PyQueries(const py::dict& settings)
    {
        const Settings own = settingsOf(settings);
        Error error;
        {
            const py::gil_scoped_release released;
            m_queries = Queries::create(own, error);
        }
        if (!m_queries) raise(error);
    }

    py::dict device() const { return dictOf(m_queries->deviceReport()); }
    // Returns why the host took over from a device.
    std::string hostReason() const { return m_queries->error().text(); }

    py::array motions(const Array<CcdQuery>& questions, const py::dict& settings)
    {
        const CcdSettings own = ccdSettingsOf(settings);
        py::array_t<CcdResult> results(questions.size());
        const CcdQuery* const from = questions.data();
        CcdResult* const to = results.mutable_data();
        const std::size_t count = std::size_t(questions.size());
        ask([&] { return m_queries->motions(from, count, own, to); });
        return results;
    }

    py::array triangles(const Array<TriangleQuery>& questions, bool exact)
    {
        py::array_t<std::uint32_t> results(questions.size());
        const TriangleQuery* const from = questions.data();
        std::uint32_t* const to = results.mutable_data();
        const std::size_t count = std::size_t(questions.size());
        const TriangleTest test = exact ? TriangleTest::Exact : TriangleTest::Certified;
        ask([&] { return m_queries->triangles(from, count, test, to); });
        return results;
    }

    py::tuple meshPairs(const Floats& positionsA, const Indices& trianglesA, const Indices& edgesA, bool hasOther,
                        const Floats& positionsB, const Indices& trianglesB, const Indices& edgesB, float radius)
    {
        const MeshDescription a = meshOf(positionsA, trianglesA, edgesA), b = meshOf(positionsB, trianglesB, edgesB);
        MeshPairs found;
        ask([&] { return m_queries->meshPairs(a, hasOther ? &b : nullptr, radius, found); });
        return py::make_tuple(found.m_limits, found.m_candidates, found.m_withinCount, found.m_intersectingCount,
                              pairsOf(found.m_within), pairsOf(found.m_intersecting));
    }

    py::tuple meshMotion(const Floats& positions, const Indices& triangles, const Indices& edges, const Floats& end,
                         const py::dict& settings)
    {
        const CcdSettings own = ccdSettingsOf(settings);
        const MeshDescription mesh = meshOf(positions, triangles, edges);
        const float* const to = dataOf(end);
        MeshMotion found;
        ask([&] { return m_queries->meshMotion(mesh, to, own, found); });
        return py::make_tuple(
            found.m_limits, found.m_trianglePairs, found.m_vertexFaceCandidates, found.m_edgeCandidates,
            found.m_vertexFaceHits, found.m_edgeHits,
            py::array_t<TouchingFeatures>(py::ssize_t(found.m_touching.size()), found.m_touching.data()));
    }

    static CcdSettings ccdSettingsOf(const py::dict& settings)
    {
        static_assert(fieldCount<CcdSettings>() == 4, "each field is read below and given in defaultCcd()");
        CcdSettings own = {};
        own.m_separation = valueOf<float>(settings, "separation");
        own.m_tolerance = valueOf<float>(settings, "tolerance");
        own.m_timeTolerance = valueOf<float>(settings, "time_tolerance");
        own.m_boxLimit = valueOf<unsigned>(settings, "box_limit");
        return own;
    }

private:
    template <class Question>
    void ask(const Question& question)
    {
        m_turn.run(
            [&]
            {
                if (!question()) raise(m_queries->error());
            });
    }

    std::unique_ptr<Queries> m_queries;
    Turn m_turn;
};

py::dict defaultCcd()
{
    const CcdSettings settings = defaultCcdSettings();
    py::dict found;
    found["separation"] = settings.m_separation;
    found["tolerance"] = settings.m_tolerance;
    found["time_tolerance"] = settings.m_timeTolerance;
    found["box_limit"] = settings.m_boxLimit;
    return found;
}
}  // namespace

void bindQueries(py::module_& module)
{
    PYBIND11_NUMPY_DTYPE_EX(CcdQuery, m_start, "start", m_end, "end", m_kind, "kind");
    PYBIND11_NUMPY_DTYPE_EX(CcdResult, m_hit, "hit", m_time, "time", m_u, "u", m_v, "v", m_boxes, "boxes");
    PYBIND11_NUMPY_DTYPE_EX(TriangleQuery, m_a, "a", m_b, "b");
    PYBIND11_NUMPY_DTYPE_EX(TouchingFeatures, m_kind, "kind", m_vertices, "vertices", m_time, "time");
    module.attr("MOTION_QUERY") = py::dtype::of<CcdQuery>();
    module.attr("TRIANGLE_QUERY") = py::dtype::of<TriangleQuery>();
    module.attr("CANDIDATE_LIMIT") = std::uint32_t(kQueryCandidateLimit);
    module.attr("ANSWER_LIMIT") = std::uint32_t(kQueryAnswerLimit);
    module.def("default_ccd_settings", defaultCcd);
    py::class_<PyQueries>(module, "Queries")
        .def(py::init<const py::dict&>())
        .def("device", &PyQueries::device)
        .def("host_reason", &PyQueries::hostReason)
        .def("motions", &PyQueries::motions)
        .def("triangles", &PyQueries::triangles)
        .def("mesh_pairs", &PyQueries::meshPairs)
        .def("mesh_motion", &PyQueries::meshMotion);
}
}  // namespace drape
