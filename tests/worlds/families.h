// The families of random worlds: each function builds one kind of world.
#pragma once

#include "tests/worlds/world_builder.h"

namespace drape::test
{
// Ground that cloth falls on (ground_worlds.cpp).
void buildTerrain(WorldBuilder& builder);     // hills
void buildFineMesh(WorldBuilder& builder);    // obstacle triangles much smaller than cloth triangles
void buildCoarseMesh(WorldBuilder& builder);  // two triangles of up to 100 m
void buildCrumpled(WorldBuilder& builder);    // cloth whose nodes start anywhere in a ball
void buildCracks(WorldBuilder& builder);      // triangles that share no vertices, with gaps and mixed winding
void buildWaveFloor(WorldBuilder& builder);   // hills that swing

// Solid things that rest (solid_worlds.cpp).
void buildBlob(WorldBuilder& builder);              // a bumpy sphere
void buildBoxes(WorldBuilder& builder);             // boxes at random angles
void buildRing(WorldBuilder& builder);              // a torus
void buildCorner(WorldBuilder& builder);            // cloth thrown into a concave corner of three walls
void buildDegenerate(WorldBuilder& builder);        // duplicate triangles, duplicate vertices, no area
void buildSelfIntersecting(WorldBuilder& builder);  // solids that overlap
void buildSlowScale(WorldBuilder& builder);         // a solid whose scale changes slowly

// Thin and sharp things (thin_worlds.cpp).
void buildSpikes(WorldBuilder& builder);      // a field of sharp cones
void buildFunnel(WorldBuilder& builder);      // an open cone
void buildTwoSheets(WorldBuilder& builder);   // two sheets that are nearer than the thickness
void buildNeedleRain(WorldBuilder& builder);  // single triangles down to 10 µm of width
void buildSlats(WorldBuilder& builder);       // narrow boards and strips
void buildChimney(WorldBuilder& builder);     // cloth wider than the shaft that it falls into

// Obstacles that move (moving_worlds.cpp).
void buildJaws(WorldBuilder& builder);      // two plates that close down to more than twice the thickness
void buildFan(WorldBuilder& builder);       // turning blades
void buildConveyor(WorldBuilder& builder);  // a belt below a block that rests
void buildSpinBox(WorldBuilder& builder);   // a box that turns
void buildDrawer(WorldBuilder& builder);    // a plate that is pulled out from beneath cloth

// Cloth that something holds or inflates (held_worlds.cpp).
void buildRod(WorldBuilder& builder);         // an edge that is wound up on a rod
void buildPressure(WorldBuilder& builder);    // a closed body under pressure
void buildMovingPins(WorldBuilder& builder);  // corners that are dragged over hills
void buildAnchors(WorldBuilder& builder);     // cloth anchored to a rigid body

// Dynamic bodies that fall on cloth, which hangs or falls (load_worlds.cpp).
void buildLoads(WorldBuilder& builder);

// Ropes, and cloth with a fringe, over something round or sharp (rope_worlds.cpp).
void buildRopes(WorldBuilder& builder);
}  // namespace drape::test
