// Materials name lobes, of which the trace takes a record.
#include "physics/scatter_registry.hpp"
#include "specimen/description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::specimen {
namespace {

std::string problem_of(const Material& material) {
    try {
        (void)material_record(material);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ScatterRegistry, NamesEveryModelWithItsParameters) {
    std::vector<std::string> names;
    for (const auto& model : physics::scatter_registry) {
        names.emplace_back(model.name);
        for (const auto& parameter : model.parameters) {
            EXPECT_LE(parameter.minimum, parameter.fallback) << names.back();
            EXPECT_LE(parameter.fallback, parameter.maximum) << names.back();
            EXPECT_FALSE(parameter.meaning.empty()) << names.back();
        }
    }
    EXPECT_THAT(names, testing::IsSupersetOf({"henyey-greenstein", "lambertian", "mirror"}));
    const auto& first = physics::scatter_registry[physics::f64::SCATTER_HENYEY_GREENSTEIN];
    ASSERT_EQ(first.parameters.size(), 1u);
    EXPECT_EQ(first.parameters[0].name, "g");
    EXPECT_EQ(first.parameters[0].minimum, -0.9);
    EXPECT_EQ(first.parameters[0].maximum, 1);
    EXPECT_FALSE(first.delta);
    EXPECT_TRUE(physics::scatter_registry[physics::f64::SCATTER_MIRROR].delta);
}

TEST(Material, BecomesTheRecordLobeByLobe) {
    const auto record =
        material_record({{{"mirror", 0.1, {}}, {"henyey-greenstein", 0.2, {0.7}}, {"lambertian", 0.3, {}}}});
    EXPECT_EQ(record.lobe_0.model, physics::f64::SCATTER_MIRROR);
    EXPECT_EQ(record.lobe_1.model, physics::f64::SCATTER_HENYEY_GREENSTEIN);
    EXPECT_EQ(record.lobe_1.parameter_0, 0.7);
    // The lobe's table is filled: the norm at normal incidence is that of the Legendre series of scatter_test.cpp, the
    // table is good to 1e-6.
    auto tabulated = record.lobe_1;
    EXPECT_NEAR(physics::f64::henyey_greenstein_norm(0.7, tabulated.table, 1.0), 0.735169, 1.5e-6);
    EXPECT_EQ(record.lobe_2.model, physics::f64::SCATTER_LAMBERTIAN);
    EXPECT_EQ(record.lobe_0.weight, 0.1);
    EXPECT_EQ(record.lobe_1.weight, 0.2);
    EXPECT_EQ(record.lobe_2.weight, 0.3);
    EXPECT_EQ(record.lobe_3.weight, 0);
    // A material of which nothing is said is Lambertian and white.
    const auto standard = material_record({});
    EXPECT_EQ(standard.lobe_0.model, physics::f64::SCATTER_HENYEY_GREENSTEIN);
    EXPECT_EQ(standard.lobe_0.weight, 1);
    EXPECT_EQ(standard.lobe_0.parameter_0, 0);
    EXPECT_EQ(standard.lobe_1.weight, 0);
}

TEST(Material, RefusesWhatIsNoMaterial) {
    using testing::AllOf;
    using testing::HasSubstr;
    const Lobe fifth{"lambertian", 0.2, {}};
    EXPECT_EQ(problem_of({{fifth, fifth, fifth, fifth}}), "");
    EXPECT_THAT(problem_of({{fifth, fifth, fifth, fifth, fifth}}), AllOf(HasSubstr("5 lobes"), HasSubstr("at most 4")));
    EXPECT_EQ(problem_of({{{"lambertian", 0.7, {}}, {"mirror", 0.1, {}}, {"mirror", 0.2, {}}}}),
              ""); // 1 but for rounding
    EXPECT_THAT(problem_of({{{"lambertian", 0.7, {}}, {"mirror", 0.31, {}}}}),
                AllOf(HasSubstr("add up to 1.01"), HasSubstr("at most 1")));
    EXPECT_THAT(problem_of({{{"lambertian", 0, {}}}}), HasSubstr("specimen.material.weight"));
    EXPECT_THAT(problem_of({{{"lambertian", 1.1, {}}}}), HasSubstr("specimen.material.weight"));
    EXPECT_THAT(problem_of({{{"lambertian", std::nan(""), {}}}}), HasSubstr("specimen.material.weight"));
    EXPECT_THAT(problem_of({{{"lambert", 1, {}}}}), HasSubstr("lambert with 0 parameters"));
    EXPECT_THAT(problem_of({{{"lambertian", 1, {0.5}}}}), HasSubstr("lambertian with 1 parameters"));
    EXPECT_THAT(problem_of(Material::henyey_greenstein(-0.91)),
                AllOf(HasSubstr("specimen.material.g"), HasSubstr("[-0.9, 1]")));
    EXPECT_THAT(problem_of(Material::henyey_greenstein(std::nan(""))), HasSubstr("specimen.material.g"));
}

} // namespace
} // namespace vkfv::specimen
