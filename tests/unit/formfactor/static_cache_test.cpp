#include "solver/formfactor/static_cache.h"

#include <random>
#include <unistd.h>

#include <gmock/gmock.h>

#include "solver/base/error.h"
#include "solver/base/file.h"
#include "tests/support/lined_world.h"

namespace afterglow {
namespace {

using testing::LinedWorld;

class StaticCache : public ::testing::Test {
  protected:
    StaticCache()
        : lined_(testing::small_room(), 0.8F, 16),
          key_(key_of(lined_, 1)),
          lines_(make_static_lines(lined_.mesh, lined_.sight, lined_.light)) {
        std::filesystem::remove_all(folder_);
        extend_static_lines(lines_, lined_.mesh, lined_.sight, lined_.light, lined_.caster, 16, Context(1));
    }
    ~StaticCache() override { std::filesystem::remove_all(folder_); }

    static Hash128 key_of(const LinedWorld& lined, std::uint64_t seed) {
        return static_key(lined.world, lined.mesh, lined.sight, lined.lamps, lined.light.lines_per_patch(),
                          seed);
    }
    [[nodiscard]] std::optional<StaticLines> load() const {
        return load_static_lines(folder_, key_, lined_.mesh, 16, lined_.light.lines_per_patch());
    }
    [[nodiscard]] std::filesystem::path file() const { return folder_ / (key_.hex() + ".lines"); }

    // Tests may run at the same time, each in a process of its own.
    std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) /
                                    ("afterglow_static_cache_" + std::to_string(::getpid()));
    LinedWorld lined_;
    Hash128 key_;
    StaticLines lines_;
};

TEST_F(StaticCache, WhatIsKeptComesBack) {
    EXPECT_FALSE(load().has_value());
    save_static_lines(folder_, key_, lines_);
    const auto back = load();
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(back->background.patch, lines_.background.patch);
    EXPECT_EQ(back->background.distance, lines_.background.distance);
    EXPECT_EQ(back->light_contribution, lines_.light_contribution);
    EXPECT_EQ(back->directions, 16U);
}

TEST_F(StaticCache, ADamagedFileIsNeverTrusted) {
    save_static_lines(folder_, key_, lines_);
    const std::string good = read_file(file());
    std::mt19937 random(5);
    for (int k = 0; k < 200; ++k) {
        std::string bad = good;
        bad[random() % bad.size()] ^= static_cast<char>(1U << (random() % 8U));
        write_file(file(), bad);
        EXPECT_FALSE(load().has_value());
    }
    for (const std::size_t length : {std::size_t{0}, std::size_t{7}, good.size() / 2, good.size() - 1}) {
        write_file(file(), good.substr(0, length));
        EXPECT_FALSE(load().has_value()) << length;
    }
    write_file(file(), good + "x");
    EXPECT_FALSE(load().has_value());
    write_file(file(), good);
    EXPECT_TRUE(load().has_value());
}

TEST_F(StaticCache, AnotherSceneHasAnotherKey) {
    EXPECT_NE(key_of(lined_, 2), key_);
    World moved = testing::small_room();
    moved.bodies[furniture].positions[0].x += 1e-3F;
    EXPECT_NE(key_of(LinedWorld(std::move(moved), 0.8F, 16), 1), key_);
    EXPECT_NE(key_of(LinedWorld(testing::small_room(), 0.8F, 32), 1), key_);
    World repainted = testing::small_room();
    repainted.materials[0].reflectance = Rgb(0.1F);
    repainted.bodies[1].path.keys[1].value.translation.x += 0.5F;
    EXPECT_EQ(key_of(LinedWorld(std::move(repainted), 0.8F, 16), 1), key_);
}

TEST_F(StaticCache, AFolderThatCannotBeMadeIsAnError) {
    write_file(folder_, "a file is in the way");
    EXPECT_THROW(save_static_lines(folder_ / "cache", key_, lines_), Error);
}

}  // namespace
}  // namespace afterglow
