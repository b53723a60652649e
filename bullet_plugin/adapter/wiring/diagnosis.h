// Lists the problems of a world that Drape can detect: one line each, for a person.
//
// Input: a world between steps, before or after its first. Cost: a check of every pair of a soft body and another
// object and, where their boxes meet, an exact check of their triangles: milliseconds to seconds, outside any step.
// Errors: exceptions pass through.
#pragma once

#include <string>

class btCollisionWorld;

namespace drape
{
class Plugin;

// Lines joined by line feeds; empty when nothing is wrong.
std::string diagnosisOf(const Plugin& plugin, const btCollisionWorld& world);
}  // namespace drape
