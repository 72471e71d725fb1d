#include "solver/radiosity/problem.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/base/error.h"
#include "tests/unit/radiosity/problems.h"

namespace afterglow {
namespace {

using test::OwnedProblem;

struct BadProblem {
    const char* field;
    std::function<void(OwnedProblem&)> spoil;
};

TEST(Problem, NamesTheFieldThatIsWrong) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const BadProblem bad[] = {
        {"area", [](OwnedProblem& p) { p.area[2] = 0; }},
        {"area", [&](OwnedProblem& p) { p.area[2] = nan; }},
        {"form factors", [](OwnedProblem& p) { p.area.push_back(1); }},
        {"emission", [](OwnedProblem& p) { p.emission.pop_back(); }},
        {"emission", [](OwnedProblem& p) { p.emission[3].g = -1; }},
        {"emission", [](OwnedProblem& p) { p.emission[3].g = 2e30F; }},
        {"reflectance", [](OwnedProblem& p) { p.reflectance.push_back(Rgb(0)); }},
        {"reflectance", [&](OwnedProblem& p) { p.reflectance[5].b = nan; }},
        {"external irradiance", [](OwnedProblem& p) { p.external_irradiance = {Rgb(1)}; }},
        {"external irradiance", [](OwnedProblem& p) { p.external_irradiance.assign(6, Rgb(-1)); }},
    };
    for (const BadProblem& b : bad) {
        OwnedProblem problem = test::unit_cube(0.5F);
        ASSERT_NO_THROW(check(problem.view()));
        b.spoil(problem);
        try {
            check(problem.view());
            ADD_FAILURE() << b.field;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
            EXPECT_EQ(error.place(), b.field);
        }
    }
}

TEST(Problem, GainIsTheLargestShareAnyPatchKeeps) {
    OwnedProblem plates{
        test::matrix_of({{0, .5}, {1, 0}}), {1, 3}, {Rgb(1), Rgb(0)}, {Rgb(.5F, .75F, .25F), Rgb(.125F)}, {}};
    const Enclosure enclosure = enclosure_of(plates.view(), Context(1));
    EXPECT_DOUBLE_EQ(enclosure.gain, .375);  // the green ¾ of a row that sums to ½
    EXPECT_DOUBLE_EQ(enclosure.closure, (1 * .5 + 3 * 1.0) / 4);
}

TEST(Problem, EnclosureIsTheSameForAnyNumberOfThreads) {
    const OwnedProblem problem = test::random_problem(1, 1300, test::Closure::open, 0.9F);
    const Enclosure one = enclosure_of(problem.view(), Context(1));
    const Enclosure four = enclosure_of(problem.view(), Context(4));
    EXPECT_EQ(one.gain, four.gain);
    EXPECT_EQ(one.closure, four.closure);
}

}  // namespace
}  // namespace afterglow
