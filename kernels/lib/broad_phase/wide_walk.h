// Stacks of traversals of the wide tree over patches (shared/patch.h). For kernels only.
#ifndef DRAPE_LIB_WIDE_WALK_H
#define DRAPE_LIB_WIDE_WALK_H

#include "../../shared/patch.h"

// Entries of a traversal's stack are nodes of the wide tree, with their level in the high bits.
#define DRAPE_LEVEL_SHIFT 28
// Levels of the wide tree over 2^28 triangles.
#define DRAPE_LEVELS 7
// Stack size of a traversal that takes a node at a time from the lowest remaining level: each level has the children
// of one node on the stack.
#define DRAPE_WALK_STACK (DRAPE_LEVELS * DRAPE_PATCH_WIDTH)

// Maximum nodes that a group tests together; the group has as many times DRAPE_PATCH_WIDTH lanes.
#define DRAPE_WALK_NODES 4
// Maximum number of the root's children at which a group's traversal begins with them.
#define DRAPE_WALK_BEGIN 4

static uint walkEntry(const uint level, const uint index)
{
    return (level << DRAPE_LEVEL_SHIFT) + index;
}

static uint entryLevel(const uint entry)
{
    return entry >> DRAPE_LEVEL_SHIFT;
}

// Returns the node's index in its level.
static uint entryIndex(const uint entry)
{
    return entry & ((1u << DRAPE_LEVEL_SHIFT) - 1u);
}

// Puts the root on the stack, or its children if they are few. Returns the number of entries.
static uint beginWalk(__local uint* stack, __global const uint* levels, const uint top)
{
    const uint children = top > 1 ? levels[top - 1] - levels[top - 2] : 0;
    const int skips = children > 0 && children <= DRAPE_WALK_BEGIN;
    const uint nodes = skips ? children : 1, level = skips ? top - 1 : top;
    for (uint i = 0; i < nodes; ++i)
        stack[i] = walkEntry(level, i);
    return nodes;
}

// Returns how many nodes are taken from the stack together: those on top that belong to one level.
static uint nodesInTurn(__local const uint* stack, const uint depth, const uint most)
{
    uint nodes = 1;
    while (nodes < min(depth, most) && entryLevel(stack[depth - 1 - nodes]) == entryLevel(stack[depth - 1]))
        ++nodes;
    return nodes;
}

#endif
