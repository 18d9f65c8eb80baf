// spawn:N on maps that name their player starts in their own way.

#include <gtest/gtest.h>

#include "host/still/still_scene.hpp"

namespace q3rt {
namespace {

MapEntity start(const char* className, const char* origin) {
    MapEntity entity;
    entity.pairs = {{"classname", className}, {"origin", origin}, {"angle", "90"}};
    return entity;
}

TEST(SpawnPoints, AreThoseOfDeathmatchWhereThereAreAny) {
    const auto points = findSpawnPoints({start("info_player_start", "1 0 0"), start("info_player_deathmatch", "2 0 0"),
                                         start("team_CTF_redspawn", "3 0 0")});
    ASSERT_EQ(points.size(), 1u);
    EXPECT_EQ(points[0].origin, vec3(2, 0, 26));
    EXPECT_EQ(points[0].yawDegrees, 90);
}

TEST(SpawnPoints, OfTeamMapsAreTheirOtherStarts) {
    const auto points = findSpawnPoints({start("team_CTF_bluespawn", "1 0 0"), start("team_CTF_redspawn", "2 0 0"),
                                         start("info_player_start", "3 0 0"), start("team_CTF_redflag", "4 0 0"),
                                         start("team_CTF_redspawn", "5 0 0")});
    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points[0].origin.x, 3);
    EXPECT_EQ(points[1].origin.x, 2);
    EXPECT_EQ(points[2].origin.x, 5);
    EXPECT_EQ(points[3].origin.x, 1);
}

TEST(SpawnPoints, OfAMapWithoutStartsAreNone) { EXPECT_TRUE(findSpawnPoints({start("light", "1 0 0")}).empty()); }

} // namespace
} // namespace q3rt
