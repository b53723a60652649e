# Tiers of tests by cost. CONTRIBUTING.md says when to run which.
#
#   fast   all suites that are not named here
#   full   suites that take seconds
#   slow   worlds of thousands of steps and cases of a hundred thousand triangles, which run_slow.sh runs
#
# The gate runs fast and full. Patterns are those of --gtest_filter for slow and timed tests, joined by colons, and a
# regular expression for the names of full suites.
set(slow_tests
  "*/SettledBunny.*:*/SettledPile.*:*/SettledCloth.*sphere_108*:*/SettledCloth.*sphere_115*"
  "*/BunnyDrop.*/10:*/BunnyDrop.*/50:*/Soak.TenThousand*:*/QueryLimitsTest.Row11HundredThousand*"
  "*/WorldRows.Row25*:BackgroundStart.TellsHowLong*:SelfCollision.AStackOfTen*")
string(JOIN ":" slow_tests ${slow_tests})

# Tests that measure time run alone.
set(timed_tests
  "*AWorldAtRestCostsFiveMicroseconds*:*GrowsLittleMoreThanTheContactsOfAFeature*"
  "*PrepareLeavesTheHostNothingToBuild*:*ABusyMachineIsMeasuredAgain*")
string(JOIN ":" timed_tests ${timed_tests})

set(full_suites "BunnyDrop|SettledCloth|Outputs|CpuKernelsTest|RopesDropped|SelfStepOracle"
  "MovingObstacleTest|PipelineNodesTest|LoadTest|QueryLimitsTest|StretchedCloth|Kinematic|Worlds"
  "ContactModesTest|Needles|SelfStepTest|SelfOracle|LooseEdges|Truth|Check|AnimatedMeshes|StressRows|SkipsTest"
  "BackendMove|FeatureCull|ContactsOracle|HostDeviceTest|Starts|IterationsOfBullet|Memory|BadInputTest"
  "DiscretePlate|PatchCullTest|KinematicPlate|ThreadsTest|OutOfMemory|Soak|Sheets|FastDropping|Prepared"
  "BuildLogTest|SelfCollision|ClothGuard|ClothScenes|ContactImpulses|TaskSchedulers|BuiltInScenes")
string(JOIN "|" full_suites ${full_suites})
