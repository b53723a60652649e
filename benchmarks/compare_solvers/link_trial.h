// One run of compare_solvers: a scene, its links' settings, and the solver of the links.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/compare_solvers/link_scene.h"
#include "benchmarks/support/samples.h"
#include "drape/settings.h"

namespace drape::bench
{
// Settings of Bullet, the same for every solver.
struct LinkSetting
{
    double m_stiffness = 1;   // kLST
    int m_iterations = 10;    // piterations
    double m_damping = 0.01;  // kDP, the share of a velocity that is lost in a step
};

enum class LinkSolver
{
    Bullet,            // Bullet's iterations
    BulletShuffled,    // Bullet's iterations with the links in a random order
    BulletInSubsteps,  // Bullet's iterations in as many steps as Drape has substeps, with Drape's stiffness of a link
    Drape              // Drape's substeps
};

const char* nameOf(LinkSolver solver);

// Figures of the nodes and links after one step. Energies in J; the potential energy is 0 at the height 0.
struct LinkStep
{
    double m_kinetic = 0, m_potential = 0;
    double m_stretchMean = 0, m_stretchMax = 0;  // links against their rest lengths; 0.01 for 1 %
    double m_speed = 0;                          // m/s, RMS over the nodes
    std::vector<float> m_positions;              // x y z per node, m
};

struct LinkRun
{
    LinkStep m_start;
    std::vector<LinkStep> m_steps;
    Samples m_stepMs;  // times of stepSimulation; with BulletInSubsteps of all substeps
};

// Runs the scene in `steps` steps of 1/60 s. settings: of the plugin, with LinkSolver::Drape.
LinkRun runLinks(const LinkScene& scene, int nodes, const LinkSetting& setting, LinkSolver solver, int steps,
                 const Settings& settings);
}  // namespace drape::bench
