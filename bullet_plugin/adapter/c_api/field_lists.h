// The fields, choices and status bits that other languages have, too. The C interface and the Python module copy and
// name them using these lists; c_records.cpp checks at compile time that no field is missing.
#pragma once

// clang-format off
// Lists the fields of Settings. Omits m_nameOf, which C lacks, and m_log and m_parallelFor, which have two fields in C.
#define DRAPE_SETTINGS_FIELDS(FIELD) \
    FIELD(m_backend) FIELD(m_device) FIELD(m_crossover) FIELD(m_activation) FIELD(m_mode) FIELD(m_solver) \
    FIELD(m_solverPlace) FIELD(m_dynamicConvex) FIELD(m_staticConvex) FIELD(m_surfaces) FIELD(m_clothSleeps) \
    FIELD(m_threads) FIELD(m_candidateLimit) FIELD(m_contactLimit) FIELD(m_profileKernels) FIELD(m_cacheFolder)

#define DRAPE_DEVICE_INFO_FIELDS(FIELD) \
    FIELD(m_platform) FIELD(m_name) FIELD(m_driver) FIELD(m_isGpu)

// All fields of DeviceReport but m_device.
#define DRAPE_DEVICE_REPORT_FIELDS(FIELD) \
    FIELD(m_onHost) FIELD(m_isStarting) FIELD(m_reason) FIELD(m_buildMs) FIELD(m_fromCache) FIELD(m_byCost) \
    FIELD(m_expectedPairs) FIELD(m_crossover) FIELD(m_crossoverSource) FIELD(m_measureMs)

// Fields of StepStatistics and of its bases.
#define DRAPE_STATISTICS_FIELDS(FIELD) \
    FIELD(m_clothTriangles) FIELD(m_obstacleTriangles) FIELD(m_candidates) FIELD(m_sweptTests) FIELD(m_contacts) \
    FIELD(m_selfCandidates) FIELD(m_selfSweptTests) FIELD(m_selfContacts) FIELD(m_mirrorMs) FIELD(m_predictMs) \
    FIELD(m_uploadMs) FIELD(m_waitMs) FIELD(m_refitMs) FIELD(m_broadMs) FIELD(m_narrowMs) FIELD(m_writeMs) \
    FIELD(m_readMs) FIELD(m_solveMs) FIELD(m_bulletMs) FIELD(m_writeBackMs) FIELD(m_checkMs) FIELD(m_normalsMs) \
    FIELD(m_status) FIELD(m_clothsLeftOut) FIELD(m_invalidNodes) FIELD(m_startsIntersecting) \
    FIELD(m_startIntersections) FIELD(m_retries) FIELD(m_clothsSkipped) FIELD(m_clothsSolvedOnDevice) \
    FIELD(m_clothsKept) FIELD(m_deviceWaits) FIELD(m_obstaclesKept) FIELD(m_nodesShortened) \
    FIELD(m_clothPairsSkipped) FIELD(m_clothPairsMeeting) FIELD(m_skipped) FIELD(m_onHost)

// Sums that functions of StepStatistics return, and their fields in C.
#define DRAPE_STATISTICS_SUMS(SUM) \
    SUM(m_collisionMs, collisionMs) SUM(m_solverMs, solverMs) SUM(m_callsMs, callsMs)

// Settings that are enumerations: the field, the constant of C, the enumerator, and the name in Python.
#define DRAPE_CHOICES(CHOICE) \
    CHOICE(m_backend, DRAPE_BACKEND_AUTO, Backend::Auto, "auto") \
    CHOICE(m_backend, DRAPE_BACKEND_OPENCL, Backend::OpenCl, "opencl") \
    CHOICE(m_backend, DRAPE_BACKEND_HOST, Backend::Host, "host") \
    CHOICE(m_backend, DRAPE_BACKEND_BY_COST, Backend::ByCost, "by_cost") \
    CHOICE(m_mode, DRAPE_MODE_DISCRETE, ContactMode::Discrete, "discrete") \
    CHOICE(m_mode, DRAPE_MODE_CONTINUOUS, ContactMode::Continuous, "continuous") \
    CHOICE(m_mode, DRAPE_MODE_AUTOMATIC, ContactMode::Automatic, "automatic") \
    CHOICE(m_solver, DRAPE_SOLVER_AUTO, Solver::Auto, "auto") \
    CHOICE(m_solver, DRAPE_SOLVER_DRAPE, Solver::Drape, "drape") \
    CHOICE(m_solver, DRAPE_SOLVER_BULLET, Solver::Bullet, "bullet") \
    CHOICE(m_solverPlace, DRAPE_SOLVER_PLACE_AUTO, SolverPlace::Auto, "auto") \
    CHOICE(m_solverPlace, DRAPE_SOLVER_PLACE_HOST, SolverPlace::Host, "host") \
    CHOICE(m_solverPlace, DRAPE_SOLVER_PLACE_DEVICE, SolverPlace::Device, "device") \
    CHOICE(m_dynamicConvex, DRAPE_SHAPE_CONTACTS_DRAPE, ShapeContacts::Drape, "drape") \
    CHOICE(m_dynamicConvex, DRAPE_SHAPE_CONTACTS_BULLET, ShapeContacts::Bullet, "bullet") \
    CHOICE(m_staticConvex, DRAPE_SHAPE_CONTACTS_DRAPE, ShapeContacts::Drape, "drape") \
    CHOICE(m_staticConvex, DRAPE_SHAPE_CONTACTS_BULLET, ShapeContacts::Bullet, "bullet") \
    CHOICE(m_surfaces, DRAPE_SHAPE_CONTACTS_DRAPE, ShapeContacts::Drape, "drape") \
    CHOICE(m_surfaces, DRAPE_SHAPE_CONTACTS_BULLET, ShapeContacts::Bullet, "bullet")

// Bits of a step's status: the name in C without DRAPE_STEP_, which is the name in Python, and the enumerator.
#define DRAPE_STATUS_BITS(BIT) \
    BIT(INVALID_NODES, kStepInvalidNodes) BIT(DEVICE_FAILED, kStepDeviceFailed) BIT(DEVICE_FULL, kStepDeviceFull) \
    BIT(CLOTHS_LEFT_OUT, kStepClothsLeftOut) BIT(COARSE_POSITIONS, kStepCoarsePositions) \
    BIT(STARTS_INTERSECTING, kStepStartsIntersecting) BIT(FACES_LEFT_OUT, kStepFacesLeftOut) \
    BIT(SURFACE_PASSED, kStepSurfacePassed) BIT(MOTION_HELD_BACK, kStepMotionHeldBack) \
    BIT(OUT_OF_MEMORY, kStepOutOfMemory) BIT(CLOTHS_MEET, kStepClothsMeet)
// clang-format on
