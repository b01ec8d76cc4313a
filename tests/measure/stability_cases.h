// Scenes on which methods fail, and what theory says of how they do.
#pragma once
#include <string>
#include <vector>

/// What is measured over many runs of N samples of one pixel.
enum class Metric {
    relative_variance,  // of one sample, Var X / E[X]^2
    coverage,           // share of the runs whose 95 % interval holds the truth
    below_half,         // share of the runs whose estimate is below half of the truth
    black,              // share of the runs that say 0 +- 0
    mean,               // of all runs, over the truth
};

/// A number that theory predicts.
struct Prediction {
    Metric metric;
    double value;
    bool fails = false;    // it is a failure
    bool at_most = false;  // the value is a bound
    double spread = 0;     // of a relative variance: standard deviation of one (X / E[X] - 1)^2
};

/// One scene, one pixel; `truth` is its radiance.
struct StabilityCase {
    std::string name;
    std::string scene;  // pbrt text
    double truth;
    int spp;  // N
    struct Expected {
        std::vector<std::string> methods;
        std::vector<Prediction> predictions = {};
    };
    std::vector<Expected> expected;
    std::vector<std::string> refuse = {};  // the methods that must refuse the scene
};

std::vector<StabilityCase> stability_cases();
