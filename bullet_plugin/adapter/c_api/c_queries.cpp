// The queries of drape/c_api.h.
#include "bullet_plugin/adapter/c_api/c_call.h"
#include "bullet_plugin/adapter/c_api/c_records.h"
#include "drape/queries.h"

namespace drape
{
struct DrapeQueries
{
    std::unique_ptr<Queries> m_queries;
    MeshPairs m_pairs;
    MeshMotion m_motion;
};

DrapeResult drapeQueriesCreate(const DrapeSettings* settings, DrapeQueries** queries)
{
    const char* const call = "drapeQueriesCreate";
    if (!queries) return refuseC(call, "an argument is null");
    *queries = nullptr;
    return callC(call,
                 [&]
                 {
                     std::unique_ptr<DrapeQueries> made(new DrapeQueries);
                     Error error;
                     made->m_queries = Queries::create(settingsOf(settings), error);
                     if (!made->m_queries) return failC(error);
                     *queries = made.release();
                     return DRAPE_OK;
                 });
}

void drapeQueriesDestroy(DrapeQueries* queries)
{
    delete queries;
}

DrapeResult drapeQueriesDevice(const DrapeQueries* queries, DrapeDeviceReport* device)
{
    if (!queries || !device) return refuseC("drapeQueriesDevice", "an argument is null");
    *device = reportOf(queries->m_queries->deviceReport());
    return DRAPE_OK;
}

void drapeDefaultCcdSettings(CcdSettings* settings)
{
    if (settings) *settings = defaultCcdSettings();
}

DrapeResult drapeMotions(DrapeQueries* queries, const CcdQuery* questions, size_t count, const CcdSettings* settings,
                         CcdResult* results)
{
    if (!queries) return refuseC("drapeMotions", "the handle is null");
    return resultOf(queries->m_queries->motions(questions, count, settings ? *settings : defaultCcdSettings(), results),
                    *queries->m_queries);
}

DrapeResult drapeTriangles(DrapeQueries* queries, const TriangleQuery* questions, size_t count, int test,
                           uint32_t* results)
{
    if (!queries) return refuseC("drapeTriangles", "the handle is null");
    return resultOf(queries->m_queries->triangles(questions, count, TriangleTest(test), results), *queries->m_queries);
}

DrapeResult drapeMeshPairs(DrapeQueries* queries, const DrapeMesh* a, const DrapeMesh* b, float radius,
                           DrapeMeshPairs* found)
{
    if (!queries || !a || !found) return refuseC("drapeMeshPairs", "an argument is null");
    const MeshDescription first = descriptionOf(*a), second = b ? descriptionOf(*b) : MeshDescription();
    MeshPairs& pairs = queries->m_pairs;
    if (!queries->m_queries->meshPairs(first, b ? &second : nullptr, radius, pairs))
        return failC(queries->m_queries->error());
    *found = {pairs.m_limits,        pairs.m_candidates,    pairs.m_withinCount,         pairs.m_intersectingCount,
              pairs.m_within.data(), pairs.m_within.size(), pairs.m_intersecting.data(), pairs.m_intersecting.size()};
    return DRAPE_OK;
}

DrapeResult drapeMeshMotion(DrapeQueries* queries, const DrapeMesh* mesh, const float* end, const CcdSettings* settings,
                            DrapeMeshMotion* found)
{
    if (!queries || !mesh || !found) return refuseC("drapeMeshMotion", "an argument is null");
    MeshMotion& motion = queries->m_motion;
    if (!queries->m_queries->meshMotion(descriptionOf(*mesh), end, settings ? *settings : defaultCcdSettings(), motion))
        return failC(queries->m_queries->error());
    *found = {motion.m_limits,         motion.m_trianglePairs, motion.m_vertexFaceCandidates, motion.m_edgeCandidates,
              motion.m_vertexFaceHits, motion.m_edgeHits,      motion.m_touching.data(),      motion.m_touching.size()};
    return DRAPE_OK;
}
}  // namespace drape
