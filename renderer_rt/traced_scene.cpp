#include "renderer_rt/traced_scene.hpp"

#include "blue_noise.hpp"
#include "renderer_rt/trim_effects.hpp"
#include "scene/triangle_order.hpp"
#include "shaders/shared/constants.h"
#include "shaders/shared/rt_noise.h"

namespace q3rt {

namespace {

static_assert(sizeof(kBlueNoise) == kBlueNoiseSide * kBlueNoiseSide * sizeof(RtNoise));

constexpr VkBufferUsageFlags kStreamUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                            VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                                            VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
constexpr VkDeviceSize kStreamBytes = VkDeviceSize{4} << 20; ///< at first; it grows

} // namespace

TracedScene::TracedScene(GpuContext& context, Backend backend)
    : m_context(context)
    , m_backend(backend)
    , m_structures(context.device(), context.ring().framesInFlight())
    , m_stream(context.device(),
               {.size = kStreamBytes, .usage = kStreamUsage, .domain = MemoryDomain::Upload, .name = "traced view"},
               context.ring().framesInFlight()) {
    m_noise = Buffer(context.device(),
                     {.size = sizeof(kBlueNoise),
                      .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                      .name = "blue noise"});
    context.uploader().upload(m_noise, std::as_bytes(std::span(kBlueNoise)));
    context.uploader().flush();
}

void TracedScene::setContent(const MaterialLibrary& materials, const TextureLibrary& textures) {
    dropContent();
    m_stages = std::make_unique<StageTable>(materials, textures, 1.0f);
    m_builder = std::make_unique<ViewTableBuilder>(materials, *m_stages);
    m_models = std::make_unique<ModelGeometry>(m_context.device(), m_backend);
}

void TracedScene::loadWorld(const World& world, const PreparedLights& lights) {
    m_world = &world;
    Device& device = m_context.device();
    m_statics =
        std::make_unique<StaticGeometry>(device, m_context.uploader(), world, m_builder->materials(), m_backend);
    loadLights(lights);
}

void TracedScene::loadLights(const PreparedLights& lights) {
    m_lights = std::make_unique<WorldLights>(m_context.device(), m_context.uploader(), *m_world, lights);
}

void TracedScene::dropContent() {
    m_builder.reset();
    m_stages.reset();
    m_statics.reset();
    m_lights.reset();
    m_models.reset();
    m_movingTrees.clear();
    m_world = nullptr;
    m_tables.clear();
}

void TracedScene::beginFrame() {
    const uint32_t slot = m_context.ring().slot();
    m_structures.beginFrame(slot);
    m_movingTrees.beginFrame();
    m_stream.beginFrame(slot);
    if (m_stages) m_stages->beginFrame();
}

template <typename T>
VkDeviceAddress TracedScene::send(const std::vector<T>& items) {
    return m_stream.append(std::span<const T>(items)).address;
}

void TracedScene::sendFogs(RtFrame& frame) {
    std::vector<RtFog> fogs;
    for (const FogVolume& fog : m_world ? m_world->fogs : std::vector<FogVolume>{})
        fogs.push_back({.color = fog.color,
                        .depthForOpaque = fog.depthForOpaque,
                        .normal = fog.surface.normal,
                        .distance = fog.surface.distance,
                        .hasSurface = fog.hasSurface ? 1u : 0u});
    frame.fogs = send(fogs);
    frame.noise = m_noise.address();
}

void TracedScene::sendLights(std::span<const SceneLight> lights, RtFrame& frame) {
    std::vector<RtLight> others;
    if (m_lights) others = m_lights->others();
    for (const SceneLight& light : lights)
        others.push_back(makeDynamicLight(light.origin, light.radius, light.color));
    frame.lights = send(others);
    frame.lightCount = static_cast<uint32_t>(others.size());
}

void TracedScene::resolveDynamic(const ViewGeometry& geometry, TracedView& view) {
    const VkDeviceAddress vertices = send(geometry.vertices);
    const VkDeviceAddress indices = send(m_tables.indices);
    const VkDeviceAddress surfaceOfTriangle = send(m_tables.surfaceOfTriangle);
    m_dynamicStructures.clear();
    for (const DynamicPart& part : m_tables.parts) {
        const TriangleGeometry triangles{.vertices = vertices + part.firstVertex * sizeof(Vertex),
                                         .vertexStride = sizeof(Vertex),
                                         .vertexCount = part.vertexCount,
                                         .indices = indices + part.firstIndex * sizeof(uint32_t),
                                         .triangleCount = part.triangleCount,
                                         .opaque = isOpaqueClass(part.surfaceClass)};
        view.movingTriangleCount += part.triangleCount;
        if (!usesStructures(m_backend)) continue;
        AccelerationStructure& structure = m_structures.takeBottom(triangles);
        m_dynamicStructures.push_back(&structure);
        view.builds.push_back({&structure, triangles});
        ++view.counts[static_cast<size_t>(part.structureClass)].builds;
    }
    for (size_t i = 0; i < m_tables.instances.size(); ++i) {
        if (m_tables.sources[i].dynamicPart < 0) continue;
        m_tables.instances[i].vertices += vertices;
        m_tables.instances[i].indices += indices;
        m_tables.instances[i].surfaceOfTriangle += surfaceOfTriangle;
    }
}

std::vector<uint32_t> TracedScene::instanceOrder(const ViewGeometry& geometry) const {
    std::vector<Bounds> boxes;
    for (const ViewTables::Source& source : m_tables.sources) {
        const EntityRecord& record = geometry.entities[source.entity];
        Bounds box = record.worldBounds;
        if (box.empty() && source.dynamicPart >= 0)
            for (const Vertex& vertex : dynamicTreePart(geometry, source.dynamicPart).vertices)
                box.add(vec3(record.worldFromModel * vec4(vertex.position, 1.0f)));
        boxes.push_back(box.empty() ? m_world->bounds : box);
    }
    return sahLeafOrder(boxes, 1);
}

void TracedScene::makeInstances(const ViewGeometry& geometry, TracedView& view) {
    std::vector<VkAccelerationStructureInstanceKHR> instances;
    for (const uint32_t i : instanceOrder(geometry)) {
        const ViewTables::Source& source = m_tables.sources[i];
        const AccelerationStructure& bottom = source.modelPart ? source.modelPart->structure
                                              : source.staticPart >= 0
                                                  ? m_statics->parts()[static_cast<size_t>(source.staticPart)].structure
                                                  : *m_dynamicStructures[static_cast<size_t>(source.dynamicPart)];
        const mat4& transform = geometry.entities[source.entity].worldFromModel;
        float rows[3][4];
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                rows[row][column] = transform[column][row];
        // The engine shows clockwise triangles, the tracer calls the others front faces. Only the solid class asks for
        // culling: the other classes decide for themselves.
        const VkGeometryInstanceFlagsKHR flags = source.surfaceClass == SurfaceClass::Solid
                                                     ? VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR
                                                     : VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
        instances.push_back(makeInstance(bottom, rows, i, source.mask, 0, flags));
    }
    view.instanceCount = static_cast<uint32_t>(instances.size());
    view.topInstances = m_stream.append(std::span<const VkAccelerationStructureInstanceKHR>(instances), 16);
    view.top = &m_structures.takeTop(view.instanceCount);
}

TreePart TracedScene::dynamicTreePart(const ViewGeometry& geometry, int number) const {
    const DynamicPart& part = m_tables.parts[static_cast<size_t>(number)];
    return {std::span(geometry.vertices).subspan(part.firstVertex, part.vertexCount),
            std::span(m_tables.indices).subspan(part.firstIndex, size_t{3} * part.triangleCount), part.surfaceClass};
}

size_t TracedScene::makeMovingTree(const ViewGeometry& geometry, size_t first, TracedView& view,
                                   TreeInstance& instance) {
    const std::vector<ViewTables::Source>& sources = m_tables.sources;
    m_treeParts.clear();
    m_treeKey.clear();
    bool known = true;
    for (size_t i = first; i < sources.size() && m_treeParts.size() < kBvhMostParts; ++i) {
        if (sources[i].dynamicPart < 0 || sources[i].entity != sources[first].entity) break;
        instance.masks[m_treeParts.size()] = sources[i].mask;
        m_treeParts.push_back(dynamicTreePart(geometry, sources[i].dynamicPart));
        m_treeKey.push_back(static_cast<uint64_t>(sources[i].surfaceClass));
        for (const uint32_t s : m_tables.surfacesOf(m_tables.parts[static_cast<size_t>(sources[i].dynamicPart)])) {
            m_treeKey.push_back(sourceKey(geometry.surfaces[s]));
            known &= m_treeKey.back() != 0;
        }
    }
    if (!known) m_treeKey.clear();
    const MovingTrees::Made made = m_movingTrees.make(m_treeKey, m_treeParts);
    instance.tree = sendTree(m_stream, made.tree);
    for (size_t i = first; i < first + m_treeParts.size(); ++i) {
        const DynamicPart& part = m_tables.parts[static_cast<size_t>(sources[i].dynamicPart)];
        ClassCount& of = view.counts[static_cast<size_t>(part.structureClass)];
        ++(made.built ? of.builds : of.updates);
    }
    return m_treeParts.size();
}

void TracedScene::makeTrees(const ViewGeometry& geometry, TracedView& view) {
    m_treeInstances.clear();
    const std::vector<ViewTables::Source>& sources = m_tables.sources;
    // Parts of one tree follow one another.
    for (size_t i = 0; i < sources.size();) {
        const ViewTables::Source& first = sources[i];
        TreeInstance instance;
        instance.worldFromModel = geometry.entities[first.entity].worldFromModel;
        instance.customIndex = static_cast<uint32_t>(i);
        size_t part = 0;
        if (first.modelPart) {
            instance.tree = first.modelPart->tree;
            instance.masks[part++] = first.mask;
        } else if (first.staticPart >= 0) {
            const auto& parts = m_statics->parts();
            const size_t tree = parts[static_cast<size_t>(first.staticPart)].tree;
            instance.tree = m_statics->tree(tree);
            for (; i + part < sources.size() && sources[i + part].staticPart >= 0 &&
                   sources[i + part].entity == first.entity &&
                   parts[static_cast<size_t>(sources[i + part].staticPart)].tree == tree;
                 ++part)
                instance.masks[part] = sources[i + part].mask;
        } else {
            part = makeMovingTree(geometry, i, view, instance);
        }
        m_treeInstances.push_back(instance);
        i += part;
    }
    const SceneTree tree = sendSceneTree(m_stream, m_treeInstances);
    view.instanceCount = static_cast<uint32_t>(m_treeInstances.size());
    view.frame.treeNodes = tree.nodes;
    view.frame.treeInstances = tree.instances;
}

TracedView TracedScene::prepare(const RtFrame& camera, ViewGeometry& geometry, std::span<const SceneLight> lights,
                                const PortalScene& portals) {
    TracedView view{.frame = camera};
    RtFrame& frame = view.frame;
    m_builder->build(m_world, m_statics.get(), geometry, portals, *m_models, m_tables);
    view.counts = m_tables.counts;
    if (m_lights) {
        m_lights->describe(frame);
        const std::vector<RtTriangleLight> moved = m_lights->moveTriangles(geometry);
        if (!moved.empty()) frame.triangleLights = send(moved);
        frame.lightColors = send(m_lights->colorsAt(geometry.entities[0].stage.shaderTimeSeconds));
    }
    trimEffects(camera, m_stages->states(), m_context.textures().parts(), m_tables, geometry);
    resolveDynamic(geometry, view);
    for (ModelPart* part : m_models->takeNew()) {
        ++view.counts[static_cast<size_t>(StructureClass::StaticEntity)].builds;
        if (usesStructures(m_backend)) view.builds.push_back({&part->structure, part->geometry});
    }
    if (usesStructures(m_backend))
        makeInstances(geometry, view);
    else
        makeTrees(geometry, view);
    frame.instances = send(m_tables.instances);
    frame.surfaces = send(m_tables.surfaces);
    frame.entities = send(m_tables.entities);
    frame.skies = send(m_tables.skies);
    frame.portals = send(m_tables.portals);
    frame.skyCount = static_cast<uint32_t>(m_tables.skies.size());
    frame.stages = send(m_stages->states());
    sendFogs(frame);
    sendLights(lights, frame);
    view.stagedCover = m_tables.hasStagedCover;
    if (m_tables.hasLayers) frame.flags |= kFrameLayers;
    if (m_tables.hasNear) frame.flags |= kFrameNearEntities;
    if (m_tables.skies.size() > 1) frame.flags |= kFrameSkySurfaces;
    frame.layerOrderCount = m_tables.layerOrderCount;
    frame.inverseError = usesStructures(m_backend) ? kMatrixInverseError : 0.0f;
    view.frameSlice = m_stream.reserve(sizeof(RtFrame));
    return view;
}

void TracedScene::finish(const TracedView& view) { std::memcpy(view.frameSlice.mapped, &view.frame, sizeof(RtFrame)); }

void TracedScene::recordBuilds(VkCommandBuffer commands, const TracedView& view) {
    AccelerationScratch& scratch = m_structures.scratch();
    recordBuildInputBarrier(commands);
    q3rt::recordBuilds(commands, scratch, view.builds);
    recordBuildBarrier(m_context.device(), commands);
    view.top->recordBuildTop(commands, scratch, view.topInstances.address, view.instanceCount);
    recordBuildBarrier(m_context.device(), commands);
}

} // namespace q3rt
