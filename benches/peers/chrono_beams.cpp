// The problems of beams.md with the Cosserat beam of Project Chrono (ChElementBeamIGA, cubic): tip positions and CPU time of
// the solver. Build it against a Chrono with its default modules and run it:
//
//     c++ -O2 -std=c++17 chrono_beams.cpp -I$CHRONO/include -I/usr/include/eigen3 -L$CHRONO/lib -lChrono_core -o chrono_beams
//     OMP_NUM_THREADS=1 ./chrono_beams

#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "chrono/fea/ChBuilderBeam.h"
#include "chrono/fea/ChElementBeamIGA.h"
#include "chrono/fea/ChMesh.h"
#include "chrono/geometry/ChLineBSpline.h"
#include "chrono/physics/ChSystemSMC.h"
#include "chrono/solver/ChDirectSolverLS.h"
#include "chrono/timestepper/ChStaticAnalysis.h"
#include "chrono/timestepper/ChTimestepperHHT.h"

using namespace chrono;
using namespace chrono::fea;

namespace {

// A system that says where its beams are free of stress before it starts.
struct System : ChSystemSMC {
    using ChSystem::Initialize;
};

double cpu() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

std::shared_ptr<ChBeamSectionCosserat> section(double ea, double ga, double gj, double ei, double mass, double polar) {
    // area 1, so that moduli are stiffnesses
    auto elasticity = chrono_types::make_shared<ChElasticityCosseratSimple>(ei / ea, ei / ea, gj, 1.0, ea, 1.0, ga, ga);
    auto inertia = chrono_types::make_shared<ChInertiaCosseratSimple>(mass, 1.0, polar / 2 / mass, polar / 2 / mass);
    return chrono_types::make_shared<ChBeamSectionCosserat>(inertia, elasticity);
}

// A cubic spline that goes through the arc at as many places as it has control points.
ChLineBSpline arc(int n, double radius, double angle) {
    const int p = 3, count = n + p;
    ChVectorDynamic<> knots(count + p + 1);
    for (int i = 0; i < knots.size(); i++)
        knots(i) = std::min(std::max(double(i - p) / n, 0.0), 1.0);
    Eigen::MatrixXd matrix(count, count), places(count, 3);
    for (int i = 0; i < count; i++) {
        double at = 0;
        for (int j = 1; j <= p; j++)
            at += knots(i + j) / p;
        for (int j = 0; j < count; j++) {
            std::vector<ChVector3d> unit(count, VNULL);
            unit[j] = ChVector3d(1, 0, 0);
            ChVectorDynamic<> copy = knots;
            matrix(i, j) = ChLineBSpline(p, unit, &copy).Evaluate(at).x();
        }
        const double a = angle * at;
        places.row(i) << radius * (1 - std::cos(a)), radius * std::sin(a), 0;
    }
    const Eigen::MatrixXd points = matrix.fullPivLu().solve(places);
    std::vector<ChVector3d> control;
    for (int i = 0; i < count; i++)
        control.emplace_back(points(i, 0), points(i, 1), points(i, 2));
    return ChLineBSpline(p, control, &knots);
}

// An arc of 45 degrees and 100 m, bent out of its plane by 600 N.
void bend(int n) {
    System system;
    system.SetGravitationalAcceleration(VNULL);
    system.SetSolver(chrono_types::make_shared<ChSolverSparseLU>());
    auto mesh = chrono_types::make_shared<ChMesh>();
    mesh->SetAutomaticGravity(false);
    auto spline = arc(n, 100, CH_PI / 4);
    ChBuilderBeamIGA builder;
    builder.BuildBeam(mesh, section(1e7, 5e6 * 5 / 6, 5e6 / 6, 1e7 / 12, 1, 1.0 / 6), spline, ChVector3d(0, 0, 1));
    builder.GetLastBeamNodes().front()->SetFixed(true);
    auto tip = builder.GetLastBeamNodes().back();
    system.Add(mesh);

    struct Load : ChStaticNonLinearAnalysisIncremental::LoadIncrementCallback {
        std::shared_ptr<ChNodeFEAxyzrot> tip;
        void OnLoadScaling(const double scale, const int, ChStaticNonLinearAnalysisIncremental*) override {
            tip->SetForce(ChVector3d(0, 0, 600 * scale));
        }
    };
    auto load = chrono_types::make_shared<Load>();
    load->tip = tip;
    ChStaticNonLinearAnalysisIncremental analysis;
    analysis.SetLoadIncrementCallback(load);
    analysis.SetIncrementalSteps(24);
    analysis.SetMaxIterationsNewton(20);
    analysis.SetResidualTolerance(1e-6);
    const double before = cpu();
    system.DoStaticAnalysis(analysis);
    const double took = cpu() - before;
    const auto x = tip->GetPos();
    std::printf("bend %d %.9f %.9f %.9f %.4f\n", n, x.x(), x.y(), x.z(), took);
    std::fflush(stdout);
}

// A cable of 1 m, clamped at one end, laid level with one turn of twist, let go in gravity for 0.4 s.
void swing(int n, double h) {
    System system;
    system.SetGravitationalAcceleration(ChVector3d(0, 0, -9.81));
    system.SetSolver(chrono_types::make_shared<ChSolverSparseLU>());
    auto stepper = chrono_types::make_shared<ChTimestepperHHT>(&system);
    stepper->SetAlpha(-0.1);
    stepper->SetMaxIters(20);
    stepper->SetAbsTolerances(1e-8);
    stepper->SetStepControl(false);
    system.SetTimestepper(stepper);
    auto mesh = chrono_types::make_shared<ChMesh>();
    ChBuilderBeamIGA builder;
    auto rod = section(5e3, 2e3, 0.08, 0.1, 0.5, 2.5e-5);
    builder.BuildBeam(mesh, rod, n, VNULL, ChVector3d(1, 0, 0), VECT_Y, 3);
    system.Add(mesh);
    // it is free of stress as it is here
    system.Initialize();
    for (auto& node : builder.GetLastBeamNodes())
        node->SetRot(QuatFromAngleX(CH_2PI * node->GetPos().x()) * node->GetRot());
    builder.GetLastBeamNodes().front()->SetFixed(true);
    auto tip = builder.GetLastBeamNodes().back();
    const double before = cpu();
    for (int k = 0; k < std::lround(0.4 / h); k++)
        system.DoStepDynamics(h);
    const double took = cpu() - before;
    const auto x = tip->GetPos();
    std::printf("swing %d %g %.9f %.9f %.9f %.4f\n", n, h, x.x(), x.y(), x.z(), took);
    std::fflush(stdout);
}

}  // namespace

int main() {
    for (int n : {4, 8, 16, 32, 64, 128})
        bend(n);
    const double steps[][2] = {{8, 2e-3}, {16, 1e-3}, {32, 5e-4}, {64, 2.5e-4}, {128, 6.25e-5}};
    for (auto [n, h] : steps)
        swing(int(n), h);
}
