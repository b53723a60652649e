// The parts of the study. Each adds its rows to the table; a row's "part" says which it is.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/support/arguments.h"
#include "benchmarks/support/samples.h"
#include "benchmarks/support/step_scene.h"
#include "scenes/mesh.h"

namespace drape::bench
{
struct StudyOptions : CommonOptions
{
    std::vector<std::string> m_parts, m_only;  // empty: all; only: models and scenes
    std::string m_reference;                   // JSON of another run
    Clock::time_point m_begin = Clock::now();
    std::map<std::string, std::string> m_hashes;  // hashes of the reference's good rows, see expectedHash()

    // Reads m_reference. False, with one line in `error`, when it is not what a study wrote.
    bool readReference(std::string& error);
    // The hash that the reference has for a part and a model or scene; empty without.
    std::string expectedHash(const std::string& part, const std::string& model) const;

    bool wants(const std::string& model) const;
    // Returns whether the time is used up; says so on standard error, naming what is left out.
    bool tooLate(const std::string& what) const;
};

struct Part
{
    std::string m_name;
    std::string m_title;  // with the thesis's tables and figures that it is for
    std::function<void(const StudyOptions&, Table&)> m_run;
};
const std::vector<Part>& studyParts();

// Peers' construction and refit per model: rows of the parts "construction" and "refit".
void studyPeerTrees(const StudyOptions& options, Table& table);

// The tree builders per model, compaction's share and time per level: parts "construction", "compaction" and "levels".
void studyConstruction(const StudyOptions& options, Table& table);

// Refits of one tree per model: parts "refit" and "refit_levels".
void studyRefit(const StudyOptions& options, Table& table);

// Cost, volume and visits of the builders' trees; takes the times from the rows of "construction".
void studyQuality(const StudyOptions& options, Table& table);

// Trees of two and four children and of bundles of leaves, in the build's volumes: part "shape".
void studyShapes(const StudyOptions& options, Table& table);

// Trees and steps in volumes of the build's degree: part "degree".
void studyDegrees(const StudyOptions& options, Table& table);

// Möller's test and the certified one over pairs of triangles: figure 4.9, part "triangle_tests".
void studyTriangleTests(const StudyOptions& options, Table& table);

// Every traversal over a cloth's descent onto the bunny, step by step: figures 4.6 and 4.8.
void studyTraversals(const StudyOptions& options, Table& table);

// Whole steps of the host with the front over trees of each builder, the cloth coming down and at rest.
void studyBuilders(const StudyOptions& options, Table& table);

// Steps in which obstacles come, go and move beside one that rests: part "obstacles".
void studyObstacles(const StudyOptions& options, Table& table);

// Models in the order of their size; quick: two small ones.
std::vector<std::string> studyModels(bool quick);

// Returns the vertices of a model when its tree is refitted: sheared by a quarter, so that every volume of it
// changes, and one that a refit did not make does not go unseen. The same bits everywhere.
std::vector<float> refitPositions(const std::vector<float>& positions);

// False, and a line on standard error, for a model that is not there.
bool loadModel(const std::string& model, const StudyOptions& options, TriangleMesh& mesh);

// The cloth over the bunny in 2,048 and in 131,072 triangles, as far as they are wanted; quick: a small one.
std::vector<SceneSpec> studyScenes(const StudyOptions& options);

// Loads a model and calls body, unless it is unwanted, missing or too late.
void forEachModel(const StudyOptions& options,
                  const std::function<void(const std::string&, const TriangleMesh&)>& body);
}  // namespace drape::bench
