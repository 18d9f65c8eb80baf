// Which structure a material goes to.

#include <gtest/gtest.h>

#include "renderer_rt/surface_class.hpp"
#include "scene/scene_types.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt {
namespace {

Material makeMaterial(std::vector<Stage> stages) {
    Material material;
    material.stages = std::move(stages);
    return material;
}

Stage blendedStage() {
    Stage stage;
    stage.blended = true;
    stage.source = BlendFactor::SrcAlpha;
    stage.destination = BlendFactor::OneMinusSrcAlpha;
    return stage;
}

Stage testedStage() {
    Stage stage;
    stage.alphaTest = AlphaTest::GreaterEqual128;
    return stage;
}

TEST(SurfaceClass, FollowsTheStages) {
    EXPECT_EQ(classifySurface(makeMaterial({})), std::nullopt);
    EXPECT_EQ(classifySurface(makeMaterial({Stage{}})), SurfaceClass::Solid);
    EXPECT_EQ(classifySurface(makeMaterial({Stage{}, blendedStage()})), SurfaceClass::Solid);
    EXPECT_EQ(classifySurface(makeMaterial({blendedStage()})), SurfaceClass::Layer);
    EXPECT_EQ(classifySurface(makeMaterial({blendedStage(), Stage{}})), SurfaceClass::Solid) << "covered in the end";
    EXPECT_EQ(classifySurface(makeMaterial({testedStage()})), SurfaceClass::Tested);
    Stage equal = blendedStage();
    equal.blended = false;
    equal.depthFunc = DepthFunc::Equal;
    EXPECT_EQ(classifySurface(makeMaterial({testedStage(), equal})), SurfaceClass::Tested)
        << "a stage of depthFunc equal covers only what is covered";
}

TEST(SurfaceClass, FollowsSidesSkyFogAndOffset) {
    Material material = makeMaterial({Stage{}});
    material.cull = CullMode::None;
    EXPECT_EQ(classifySurface(material), SurfaceClass::SolidTwoSided);
    material.cull = CullMode::Back;
    EXPECT_EQ(classifySurface(material), SurfaceClass::Tested);
    material.cull = CullMode::Front;
    material.polygonOffset = true;
    EXPECT_EQ(classifySurface(material), SurfaceClass::Layer) << "a decal shares the plane of another surface";
    material.isSky = true;
    EXPECT_EQ(classifySurface(material), SurfaceClass::Sky);
    Material fog = makeMaterial({});
    fog.isFog = true;
    EXPECT_EQ(classifySurface(fog), SurfaceClass::Layer);
    EXPECT_TRUE(surfaceFlags(fog, SurfaceClass::Layer) & kSurfaceFogged);
}

TEST(SurfaceClass, WhatShowsBothSidesAndLetsLightPassIsThin) {
    Material material = makeMaterial({testedStage()});
    material.contentFlags = surfaceParm::kContentsTranslucent;
    EXPECT_FALSE(surfaceFlags(material, SurfaceClass::Tested) & (kSurfaceThin | kSurfaceModel));
    material.cull = CullMode::None;
    EXPECT_TRUE(surfaceFlags(material, SurfaceClass::Tested) & kSurfaceThin);
    material.contentFlags = 0;
    EXPECT_FALSE(surfaceFlags(material, SurfaceClass::Tested) & kSurfaceThin) << "baked as a wall";
    material.light.alphaShadow = true;
    EXPECT_TRUE(surfaceFlags(material, SurfaceClass::Tested) & kSurfaceThin);
    material.polygonOffset = true;
    EXPECT_FALSE(surfaceFlags(material, SurfaceClass::Layer) & kSurfaceThin) << "a mark has a wall behind it";
    material.stages[0].bakedLight = BakedLight::LightGrid;
    EXPECT_TRUE(surfaceFlags(material, SurfaceClass::Layer) & kSurfaceModel);
    material.polygonOffset = material.light.alphaShadow = false;
    EXPECT_TRUE(surfaceFlags(material, SurfaceClass::Tested) & kSurfaceThin) << "no compiler saw it";
}

TEST(SurfaceClass, MasksSayWhoSees) {
    EXPECT_EQ(instanceMask(SurfaceClass::Solid, {}), kMaskSolid | kMaskSolidMirror | kMaskShadow);
    EXPECT_EQ(instanceMask(SurfaceClass::Layer, {}), kMaskLayer | kMaskLayerMirror) << "layers let light pass";
    EXPECT_EQ(instanceMask(SurfaceClass::Sky, {}), kMaskSky | kMaskShadow);
    Visibility weapon;
    weapon.near = true;
    weapon.mirrors = weapon.shadow = false;
    EXPECT_EQ(instanceMask(SurfaceClass::Solid, weapon), kMaskNearSolid);
    Visibility body;
    body.eye = false;
    EXPECT_EQ(instanceMask(SurfaceClass::Solid, body), kMaskSolidMirror | kMaskShadow);
}

} // namespace
} // namespace q3rt
