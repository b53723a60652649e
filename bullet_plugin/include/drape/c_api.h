// Drape for C and for languages that call C: collision queries, and worlds of cloth and triangle meshes.
//
// Functions return DRAPE_OK or an error code, after which drapeErrorText() says why and outputs are undefined. No
// exception leaves them. Handles are opaque; each belongs to one thread at a time, and several threads may have one
// each. Arrays are the caller's and are read during the call only. Arrays and texts that Drape returns are valid as
// long as the function says. SI units, world frame; bool is int, 1 or 0. The rules about fork() of drape/plugin.h
// apply. Needs neither Bullet's headers nor OpenCL's. C99; in C++ (C++11) everything is in namespace drape.
#ifndef DRAPE_C_API_H
#define DRAPE_C_API_H

#include <stddef.h>
#include <stdint.h>

#include "drape/cloth_records.h"
#include "drape/export.h"
#include "drape/query_records.h"

#ifdef __cplusplus
namespace drape
{
#endif

// Precedes every function.
#ifdef __cplusplus
#define DRAPE_C_FUNCTION extern "C" DRAPE_EXPORT
#else
#define DRAPE_C_FUNCTION DRAPE_EXPORT
#endif

// Says how a call ended.
typedef enum DrapeResult
{
    DRAPE_OK = 0,             // the call did its work
    DRAPE_BAD_INPUT = 1,      // settings or arguments are invalid: a null handle, a missing array, a value out of range
    DRAPE_OUT_OF_MEMORY = 2,  // the host ran out of memory; later calls may succeed
    DRAPE_NO_DEVICE = 3       // the requested OpenCL device is missing, unusable, or failed
} DrapeResult;

// Values of DrapeSettings::m_backend; see Backend of drape/settings.h.
enum
{
    DRAPE_BACKEND_AUTO = 0,
    DRAPE_BACKEND_OPENCL = 1,
    DRAPE_BACKEND_HOST = 2,
    DRAPE_BACKEND_BY_COST = 3
};

// Values of DrapeSettings::m_mode; see ContactMode of drape/settings.h.
enum
{
    DRAPE_MODE_DISCRETE = 0,
    DRAPE_MODE_CONTINUOUS = 1,
    DRAPE_MODE_AUTOMATIC = 2
};

// Values of DrapeSettings::m_solver; see Solver of drape/settings.h.
enum
{
    DRAPE_SOLVER_AUTO = 0,
    DRAPE_SOLVER_DRAPE = 1,
    DRAPE_SOLVER_BULLET = 2
};

// Values of DrapeSettings::m_solverPlace; see SolverPlace of drape/settings.h.
enum
{
    DRAPE_SOLVER_PLACE_AUTO = 0,
    DRAPE_SOLVER_PLACE_HOST = 1,
    DRAPE_SOLVER_PLACE_DEVICE = 2
};

// Values of DrapeSettings::m_dynamicConvex, m_staticConvex and m_surfaces; see ShapeContacts of drape/settings.h.
enum
{
    DRAPE_SHAPE_CONTACTS_DRAPE = 0,
    DRAPE_SHAPE_CONTACTS_BULLET = 1
};

// Tests of two triangles; see TriangleTest of drape/queries.h.
enum
{
    DRAPE_TEST_CERTIFIED = 0,
    DRAPE_TEST_EXACT = 1
};

// Bits of m_limits of a result; see QueryLimitBits of drape/queries.h.
enum
{
    DRAPE_QUERY_WHOLE = 0,
    DRAPE_QUERY_CANDIDATE_LIMIT = 1,
    DRAPE_QUERY_ANSWER_LIMIT = 2
};

// Bits of DrapeStatistics::m_status; see StepStatusBits of drape/report.h.
enum
{
    DRAPE_STEP_GOOD = 0,
    DRAPE_STEP_INVALID_NODES = 1,
    DRAPE_STEP_DEVICE_FAILED = 2,
    DRAPE_STEP_DEVICE_FULL = 4,
    DRAPE_STEP_CLOTHS_LEFT_OUT = 8,
    DRAPE_STEP_COARSE_POSITIONS = 16,
    DRAPE_STEP_STARTS_INTERSECTING = 32,
    DRAPE_STEP_FACES_LEFT_OUT = 64,
    DRAPE_STEP_SURFACE_PASSED = 128,
    DRAPE_STEP_MOTION_HELD_BACK = 256,
    DRAPE_STEP_OUT_OF_MEMORY = 512,
    DRAPE_STEP_CLOTHS_MEET = 1024
};

// Receives one line without a line feed about a problem of a world; see Settings::m_log. It must not call Drape
// with the handle that calls it.
typedef void (*DrapeLog)(const char* line, void* user);

// One job of Drape's: call it with an index and the context that came with it.
typedef void (*DrapeJob)(size_t index, void* context);

// Calls job(i, context) once for each i below `count`, in any order and on any threads, and returns when all have
// returned; see Settings::m_parallelFor.
typedef void (*DrapeParallelFor)(size_t count, DrapeJob job, void* context, void* user);

// Choices before Drape starts. Fields, units, ranges and defaults are those of Settings (drape/settings.h).
typedef struct DrapeSettings
{
    int m_backend;                   // DRAPE_BACKEND_…
    const char* m_device;            // part of a device's or platform's name, or "host"; "" or null for the default
    double m_crossover;              // expected triangle pairs from which the device is used; negative: measured
    float m_activation;              // reach of contacts beyond the thickness, as a fraction of it, 0 to 4
    int m_mode;                      // DRAPE_MODE_…
    int m_solver;                    // DRAPE_SOLVER_…
    int m_solverPlace;               // DRAPE_SOLVER_PLACE_…
    int m_dynamicConvex;             // DRAPE_SHAPE_CONTACTS_…, with convex shapes of dynamic bodies
    int m_staticConvex;              // DRAPE_SHAPE_CONTACTS_…, with convex shapes of other bodies
    int m_surfaces;                  // DRAPE_SHAPE_CONTACTS_…, with planes and height fields
    int m_clothSleeps;               // 1: cloth at rest falls asleep
    unsigned m_threads;              // number of threads, 0 to 64; 0: available cores, 8 at most
    size_t m_candidateLimit;         // largest number of candidates in a step or query
    size_t m_contactLimit;           // largest number of contacts in a step, or of answers of a query
    int m_profileKernels;            // 1: the device times every kernel launch
    const char* m_cacheFolder;       // folder for compiled kernels; "none": no cache; "" or null for the default
    DrapeLog m_log;                  // receives problems of worlds; names bodies by index; null: no log
    void* m_logUser;                 // passed to m_log
    DrapeParallelFor m_parallelFor;  // runs Drape's jobs on the app's job system; null: threads of Drape's own
    void* m_parallelForUser;         // passed to m_parallelFor
} DrapeSettings;

// An OpenCL device, or the host. Fields are those of DeviceInfo (drape/report.h).
typedef struct DrapeDeviceInfo
{
    const char* m_platform;  // name of the OpenCL platform
    const char* m_name;      // name of the device; "host" for the host back end
    const char* m_driver;    // version of the driver
    int m_isGpu;             // 1 for a GPU
} DrapeDeviceInfo;

// The device in use and the reason for it. Fields are those of DeviceReport (drape/report.h).
typedef struct DrapeDeviceReport
{
    int m_onHost;                   // 1 if the host back end computes
    int m_isStarting;               // 1 while a device is prepared in the background
    DrapeDeviceInfo m_device;       // the device
    const char* m_reason;           // the reason for this device, one line
    double m_buildMs;               // time to load the kernels, ms
    int m_fromCache;                // 1 if every kernel came from Drape's cache
    int m_byCost;                   // 1 if cost decides between the host and a device
    double m_expectedPairs;         // estimated number of triangle pairs
    double m_crossover;             // number of expected pairs above which the device is used
    const char* m_crossoverSource;  // origin of the crossover
    double m_measureMs;             // time of the measurement, ms; 0 without one
} DrapeDeviceReport;

// Work and cost of a step. Fields are those of StepStatistics (drape/report.h), then three sums of its functions.
// Ms: milliseconds of wall time.
typedef struct DrapeStatistics
{
    size_t m_clothTriangles;        // cloth triangles
    size_t m_obstacleTriangles;     // obstacle triangles
    uint64_t m_candidates;          // pairs of features that the broad phase found
    size_t m_sweptTests;            // pairs of features that needed the continuous test
    size_t m_contacts;              // contacts
    uint64_t m_selfCandidates;      // pairs of features of cloths that collide with themselves
    size_t m_selfSweptTests;        // pairs among them that needed the continuous test
    size_t m_selfContacts;          // contacts of cloths with themselves
    double m_mirrorMs;              // pairs, mirrors, motions of obstacles
    double m_predictMs;             // prediction
    double m_uploadMs;              // copying nodes and enqueueing
    double m_waitMs;                // waiting for the device, or the host's detection
    double m_refitMs;               // part of m_waitMs: refitting, on the host
    double m_broadMs;               // part of m_waitMs: broad phase, on the host
    double m_narrowMs;              // part of m_waitMs: narrow phase and order, on the host
    double m_writeMs;               // sorting contacts, ending paths at impacts
    double m_readMs;                // reading links and nodes
    double m_solveMs;               // links, contact sweeps, motion limits
    double m_bulletMs;              // Bullet's link solver
    double m_writeBackMs;           // writing nodes, impulses of rigid bodies
    double m_checkMs;               // checking displaced nodes
    double m_normalsMs;             // Bullet's normals
    uint32_t m_status;              // DRAPE_STEP_… bits
    size_t m_clothsLeftOut;         // cloths left out
    size_t m_invalidNodes;          // nodes left out
    size_t m_startsIntersecting;    // pairs of cloth and obstacle that started intersecting
    uint64_t m_startIntersections;  // their pairs of triangles
    size_t m_retries;               // stages that ran again because a buffer was too small
    size_t m_clothsSkipped;         // cloths without work
    size_t m_clothsSolvedOnDevice;  // cloths that an OpenCL device solved
    size_t m_clothsKept;            // cloths whose nodes stayed on the device
    size_t m_deviceWaits;           // times that the host waited for the device
    size_t m_obstaclesKept;         // obstacles that were not built, refitted or moved
    size_t m_nodesShortened;        // nodes stopped so that cloth does not meet cloth
    size_t m_clothPairsSkipped;     // pairs of smooth patches left out of the search
    size_t m_clothPairsMeeting;     // pairs of cloth that are not guarded
    int m_skipped;                  // 1 if there was nothing to do
    int m_onHost;                   // 1 if the host back end ran the step
    double m_collisionMs;           // Drape's time but for the prediction and the normals
    double m_solverMs;              // its part that follows the detection
    double m_callsMs;               // all of the soft-body solver's time, with Bullet's part
} DrapeStatistics;

// A triangle mesh of a query. Zero what is not used.
typedef struct DrapeMesh
{
    const int32_t* m_triangles;  // vertex indices, 3 per triangle
    size_t m_triangleCount;      // number of triangles
    const float* m_positions;    // x y z per vertex, m
    size_t m_vertexCount;        // number of vertices
    const int32_t* m_edges;      // edges that belong to no triangle, 2 vertex indices each
    size_t m_edgeCount;          // number of edges in m_edges
} DrapeMesh;

// Result of drapeMeshPairs(); see MeshPairs of drape/queries.h.
typedef struct DrapeMeshPairs
{
    uint32_t m_limits;                    // DRAPE_QUERY_… bits; read them before the lists
    uint64_t m_candidates;                // pairs whose volumes overlap
    uint64_t m_withinCount;               // pairs within the radius
    uint64_t m_intersectingCount;         // pairs that intersect
    const NearTriangles* m_within;        // pairs within the radius, sorted
    size_t m_withinListed;                // number of pairs in m_within
    const NearTriangles* m_intersecting;  // pairs that intersect, sorted
    size_t m_intersectingListed;          // number of pairs in m_intersecting
} DrapeMeshPairs;

// Result of drapeMeshMotion(); see MeshMotion of drape/queries.h.
typedef struct DrapeMeshMotion
{
    uint32_t m_limits;                   // DRAPE_QUERY_… bits; read them before the list
    uint64_t m_trianglePairs;            // triangle pairs whose volumes overlap
    uint64_t m_vertexFaceCandidates;     // vertex-face pairs whose volumes over the step overlap
    uint64_t m_edgeCandidates;           // edge-edge pairs whose volumes over the step overlap
    uint64_t m_vertexFaceHits;           // vertex-face pairs that touch
    uint64_t m_edgeHits;                 // edge-edge pairs that touch
    const TouchingFeatures* m_touching;  // pairs that touch, vertex-face pairs first
    size_t m_touchingListed;             // number of pairs in m_touching
} DrapeMeshMotion;

// Owns a device and answers queries.
typedef struct DrapeQueries DrapeQueries;
// Owns cloths, obstacles and a device.
typedef struct DrapeWorld DrapeWorld;

// Returns the cause of the thread's last call that failed; "" if none has. Valid until the thread's next call.
DRAPE_C_FUNCTION const char* drapeErrorText(void);
// Returns the version of the library, "major.minor.patch". Valid for ever.
DRAPE_C_FUNCTION const char* drapeVersion(void);
// Returns the same as a number that compares with DRAPE_VERSION_NUMBER (drape/version.h).
DRAPE_C_FUNCTION int drapeVersionNumber(void);
// Returns DRAPE_STEP_… bits in words, "" for a good step. Valid until the thread's next call of this function.
DRAPE_C_FUNCTION const char* drapeStatusText(uint32_t status);

// Fills `settings` with working defaults. Ignores null.
DRAPE_C_FUNCTION void drapeDefaultSettings(DrapeSettings* settings);
// Writes "drape: ", `line` and a line feed to standard error: the default of DrapeSettings::m_log. Ignores `user`.
DRAPE_C_FUNCTION void drapeLogToStandardError(const char* line, void* user);
// Sets *devices to every OpenCL device in Drape's order of preference and *count to their number. Valid until the
// thread's next call of this function. Errors: DRAPE_BAD_INPUT for null.
DRAPE_C_FUNCTION DrapeResult drapeListDevices(const DrapeDeviceInfo** devices, size_t* count);
// Returns "" if the device is available that `settings` request, else the reason in one line. Null means the
// defaults. Valid until the thread's next call of this function.
DRAPE_C_FUNCTION const char* drapeWhyNoDevice(const DrapeSettings* settings);

// Chooses the device and compiles its kernels for queries. settings: null means the defaults. Sets *queries, null
// on failure. Errors: DRAPE_BAD_INPUT for settings out of range, DRAPE_NO_DEVICE, DRAPE_OUT_OF_MEMORY.
DRAPE_C_FUNCTION DrapeResult drapeQueriesCreate(const DrapeSettings* settings, DrapeQueries** queries);
// Frees the handle and the lists of its results. Ignores null.
DRAPE_C_FUNCTION void drapeQueriesDestroy(DrapeQueries* queries);
// Describes the device in use. Texts are valid as long as the handle. Errors: DRAPE_BAD_INPUT for null.
DRAPE_C_FUNCTION DrapeResult drapeQueriesDevice(const DrapeQueries* queries, DrapeDeviceReport* device);

// Fills `settings` with working defaults of continuous collision. Ignores null.
DRAPE_C_FUNCTION void drapeDefaultCcdSettings(CcdSettings* settings);
// Answers `count` questions about two moving features each; writes `count` results. settings: null means the
// defaults. Errors: DRAPE_BAD_INPUT for a missing array, an unknown kind, or a tolerance that is negative or not
// finite; DRAPE_NO_DEVICE; DRAPE_OUT_OF_MEMORY.
DRAPE_C_FUNCTION DrapeResult drapeMotions(DrapeQueries* queries, const CcdQuery* questions, size_t count,
                                          const CcdSettings* settings, CcdResult* results);
// Tests `count` pairs of triangles; writes `count` results, 1 for a pair that intersects and 0 otherwise. test:
// DRAPE_TEST_…. Errors: DRAPE_BAD_INPUT for a missing array or an unknown test; DRAPE_NO_DEVICE;
// DRAPE_OUT_OF_MEMORY.
DRAPE_C_FUNCTION DrapeResult drapeTriangles(DrapeQueries* queries, const TriangleQuery* questions, size_t count,
                                            int test, uint32_t* results);
// Finds pairs of triangles of `a` and `b` within `radius` (m, ≥ 0) and pairs that intersect. A null `b` pairs `a`
// with itself, without triangles that share a vertex. Lists in `found` are valid until the handle's next call of
// this function. Errors: DRAPE_BAD_INPUT for a missing array, an index out of range, or a radius that is negative
// or not finite; DRAPE_NO_DEVICE; DRAPE_OUT_OF_MEMORY.
DRAPE_C_FUNCTION DrapeResult drapeMeshPairs(DrapeQueries* queries, const DrapeMesh* a, const DrapeMesh* b, float radius,
                                            DrapeMeshPairs* found);
// Finds features of a mesh that touch one another while its vertices move in straight lines to `end`, x y z per
// vertex, m: collision of the mesh with itself. settings: null means the defaults. The list in `found` is valid
// until the handle's next call of this function. Errors: as drapeMeshPairs().
DRAPE_C_FUNCTION DrapeResult drapeMeshMotion(DrapeQueries* queries, const DrapeMesh* mesh, const float* end,
                                             const CcdSettings* settings, DrapeMeshMotion* found);

// Fills `cloth` with the defaults of defaultCloth() (drape/cloth_world.h), without a mesh. Ignores null.
DRAPE_C_FUNCTION void drapeDefaultCloth(ClothDescription* cloth);
// Fills `obstacle` with the defaults of defaultObstacle(), without a mesh. Ignores null.
DRAPE_C_FUNCTION void drapeDefaultObstacle(ObstacleDescription* obstacle);

// Makes an empty world. settings: null means the defaults. Gravity is 9.81 m/s² against y. Sets *world, null on
// failure. Errors: DRAPE_BAD_INPUT for settings out of range, DRAPE_NO_DEVICE, DRAPE_OUT_OF_MEMORY.
DRAPE_C_FUNCTION DrapeResult drapeWorldCreate(const DrapeSettings* settings, DrapeWorld** world);
// Frees the handle, all cloths and obstacles, views and lists. Ignores null.
DRAPE_C_FUNCTION void drapeWorldDestroy(DrapeWorld* world);

// Sets the acceleration of all cloth, m/s². Errors: DRAPE_BAD_INPUT for values that are not finite.
DRAPE_C_FUNCTION DrapeResult drapeWorldSetGravity(DrapeWorld* world, const double gravity[3]);
// Adds a cloth and sets *index to its index: 0, 1, … in order. Errors: DRAPE_BAD_INPUT for a field out of range, a
// missing array or an index out of range; DRAPE_OUT_OF_MEMORY.
DRAPE_C_FUNCTION DrapeResult drapeWorldAddCloth(DrapeWorld* world, const ClothDescription* cloth, int* index);
// Adds an obstacle and sets *index to its index: 0, 1, … in order. Errors: as drapeWorldAddCloth().
DRAPE_C_FUNCTION DrapeResult drapeWorldAddObstacle(DrapeWorld* world, const ObstacleDescription* obstacle, int* index);
// Removes a cloth; its views become invalid. Errors: DRAPE_BAD_INPUT for an unknown index.
DRAPE_C_FUNCTION DrapeResult drapeWorldRemoveCloth(DrapeWorld* world, int cloth);
// Removes an obstacle. Errors: DRAPE_BAD_INPUT for an unknown index.
DRAPE_C_FUNCTION DrapeResult drapeWorldRemoveObstacle(DrapeWorld* world, int obstacle);

// Moves an obstacle to a pose, which it reaches at the end of the next step. position: m. rotation: a quaternion x
// y z w of any length but 0. teleport: 1 puts it there at once, so that it sweeps no path. Errors: DRAPE_BAD_INPUT
// for an unknown index or values that are not finite.
DRAPE_C_FUNCTION DrapeResult drapeWorldSetPose(DrapeWorld* world, int obstacle, const double position[3],
                                               const double rotation[4], int teleport);
// Moves an obstacle's vertices, which reach `positions` (x y z per vertex in the obstacle's own frame, m) at the
// end of the next step. vertexCount: the obstacle's. teleport: as in drapeWorldSetPose(). Errors: DRAPE_BAD_INPUT
// for an unknown index, another number of vertices, or values that are not finite.
DRAPE_C_FUNCTION DrapeResult drapeWorldSetVertices(DrapeWorld* world, int obstacle, const float* positions,
                                                   size_t vertexCount, int teleport);

// Leaves `count` triangles of an obstacle out of collision, and no others: doors and holes. triangles: their indices in
// the description; with none all collide again. Errors: DRAPE_BAD_INPUT for an unknown obstacle or triangle, or a
// missing array; DRAPE_OUT_OF_MEMORY.
DRAPE_C_FUNCTION DrapeResult drapeWorldLeaveOutTriangles(DrapeWorld* world, int obstacle, const int32_t* triangles,
                                                         size_t count);

// Pins `count` nodes of a cloth (pinned 1), or lets them go with the masses that they had (0). Errors:
// DRAPE_BAD_INPUT for an unknown cloth or node.
DRAPE_C_FUNCTION DrapeResult drapeWorldSetPinned(DrapeWorld* world, int cloth, const int32_t* nodes, size_t count,
                                                 int pinned);
// Moves `count` nodes of a cloth at once to `positions`, x y z each, m. Pinned nodes take the cloth along in the
// next step. teleport: 1 for cloth that is put elsewhere; Drape then pushes apart what intersects there. Errors:
// DRAPE_BAD_INPUT for an unknown cloth or node, or values that are not finite.
DRAPE_C_FUNCTION DrapeResult drapeWorldSetPositions(DrapeWorld* world, int cloth, const int32_t* nodes, size_t count,
                                                    const float* positions, int teleport);
// Sets velocities of `count` nodes of a cloth, x y z each, m/s. Errors: DRAPE_BAD_INPUT for an unknown cloth or
// node, a pinned node, or values that are not finite.
DRAPE_C_FUNCTION DrapeResult drapeWorldSetVelocities(DrapeWorld* world, int cloth, const int32_t* nodes, size_t count,
                                                     const float* velocities);

// Runs one step of `dt` seconds, above 0. Problems of the step are bits of DrapeStatistics::m_status, not errors.
// Errors: DRAPE_BAD_INPUT for another dt.
DRAPE_C_FUNCTION DrapeResult drapeWorldStep(DrapeWorld* world, double dt);

// Gives Bullet's own arrays of a cloth's nodes, without copying. Valid until the cloth is removed; steps write
// them. Errors: DRAPE_BAD_INPUT for an unknown cloth.
DRAPE_C_FUNCTION DrapeResult drapeWorldNodes(const DrapeWorld* world, int cloth, NodeView* view);
// Copies a cloth's nodes to the caller's arrays, x y z per node as float; null leaves an array out. Positions: m.
// Velocities: m/s. Normals: unit. Errors: DRAPE_BAD_INPUT for an unknown cloth.
DRAPE_C_FUNCTION DrapeResult drapeWorldCopyNodes(const DrapeWorld* world, int cloth, float* positions,
                                                 float* velocities, float* normals);

// Describes the work and cost of the last step. Errors: DRAPE_BAD_INPUT for null.
DRAPE_C_FUNCTION DrapeResult drapeWorldStatistics(const DrapeWorld* world, DrapeStatistics* statistics);
// Sets *contacts to the contacts of the last step in canonical order and *count to their number. Valid until the
// handle's next call of this function. Errors: DRAPE_BAD_INPUT for null, DRAPE_OUT_OF_MEMORY.
DRAPE_C_FUNCTION DrapeResult drapeWorldContacts(DrapeWorld* world, const ClothContact** contacts, size_t* count);
// Makes the coming steps keep contacts with their impulses, or not (the default); see Plugin::recordContacts(). Errors:
// DRAPE_BAD_INPUT for null.
DRAPE_C_FUNCTION DrapeResult drapeWorldRecordContacts(DrapeWorld* world, int record);
// Sets *contacts to the contacts of the last step with their impulses, of cloth with cloth, too, and *count to their
// number: none unless they were recorded. Valid until the handle's next call of this function. Errors: as
// drapeWorldContacts().
DRAPE_C_FUNCTION DrapeResult drapeWorldStepContacts(DrapeWorld* world, const ClothStepContact** contacts,
                                                    size_t* count);
// Sets *pairs to the triangles of cloth with self collision that intersected where the last step began, and *count
// to their number. Valid until the handle's next call of this function. Errors: as drapeWorldContacts().
DRAPE_C_FUNCTION DrapeResult drapeWorldClothTriangles(DrapeWorld* world, const ClothTriangles** pairs, size_t* count);

// Describes the device in use. Texts are valid until the handle's next step. Errors: DRAPE_BAD_INPUT for null.
DRAPE_C_FUNCTION DrapeResult drapeWorldDevice(const DrapeWorld* world, DrapeDeviceReport* device);
// Waits until the start of a device in the background has ended, if there is one. Errors: DRAPE_BAD_INPUT for null.
DRAPE_C_FUNCTION DrapeResult drapeWorldAwaitDevice(DrapeWorld* world);
// Returns one line with the device, the reason for it and the last step. Valid until the thread's next call of this
// function. "" for null.
DRAPE_C_FUNCTION const char* drapeWorldReport(const DrapeWorld* world);
// Returns problems of the world, one line each; see Plugin::diagnose(). Takes milliseconds to seconds. Valid until
// the thread's next call of this function. "" for null.
DRAPE_C_FUNCTION const char* drapeWorldDiagnose(const DrapeWorld* world);
// Returns why the host took over from a device, "" if it did not. Valid until the thread's next call of this
// function. "" for null.
DRAPE_C_FUNCTION const char* drapeWorldDeviceError(const DrapeWorld* world);

#ifdef __cplusplus
}  // namespace drape
#endif

#endif
