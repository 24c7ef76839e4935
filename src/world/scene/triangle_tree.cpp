#include "detail/triangle_tree.hpp"

#if SKYLOOP_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace skyloop::inline world {

namespace {

constexpr float farthest = 1e9F;  ///< m; satellites are nearer

/// Embree 3 and 4 differ in how a query is told of coherence, and in nothing else that is used here.
#if SKYLOOP_EMBREE_MAJOR >= 4
struct Query {
    RTCIntersectArguments intersect;
    explicit Query(bool coherent) {
        rtcInitIntersectArguments(&intersect);
        intersect.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
    void nearest(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect); }
    void nearest(const int* valid, RTCScene scene, RTCRayHit16& rays) {
        rtcIntersect16(valid, scene, &rays, &intersect);
    }
    static void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, nullptr); }
    static void occluded(const int* valid, RTCScene scene, RTCRay16& rays) {
        rtcOccluded16(valid, scene, &rays, nullptr);
    }
};
#else
struct Query {
    RTCIntersectContext context;
    explicit Query(bool coherent) {
        rtcInitIntersectContext(&context);
        context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    }
    void nearest(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
    void nearest(const int* valid, RTCScene scene, RTCRayHit16& rays) { rtcIntersect16(valid, scene, &context, &rays); }
    // Never with the coherent flag: Embree 3.13.5 can loop for ever in rtcOccluded16 with it.
    static void occluded(RTCScene scene, RTCRay& ray) {
        Query query(false);
        rtcOccluded1(scene, &query.context, &ray);
    }
    static void occluded(const int* valid, RTCScene scene, RTCRay16& rays) {
        Query query(false);
        rtcOccluded16(valid, scene, &query.context, &rays);
    }
};
#endif

/// Embree takes numbers alone, of which it can take squares; some builds of it stop the program for others.
bool can_be_traced(const SceneRay& ray) {
    const auto within = [](const Eigen::Vector3d& vector, double most) {
        return std::abs(vector.x()) <= most && std::abs(vector.y()) <= most && std::abs(vector.z()) <= most;
    };
    return within(ray.origin, farthest) && within(ray.direction, 2);
}

void set_ray(RTCRay& ray, const SceneRay& from, float begin, float length) {
    ray.org_x = static_cast<float>(from.origin.x());
    ray.org_y = static_cast<float>(from.origin.y());
    ray.org_z = static_cast<float>(from.origin.z());
    ray.dir_x = static_cast<float>(from.direction.x());
    ray.dir_y = static_cast<float>(from.direction.y());
    ray.dir_z = static_cast<float>(from.direction.z());
    ray.tnear = begin;
    ray.tfar = length;
    ray.time = 0;
    ray.mask = ~0U;
    ray.id = 0;
    ray.flags = 0;
}

/// Lanes beyond the list are switched off, and those of rays that are none; all hold numbers.
void set_rays(RTCRay16& packet, int* valid, std::span<const SceneRay> rays) {
    static const SceneRay unused{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
    for (std::size_t lane = 0; lane < TriangleTree::width; ++lane) {
        const bool used = lane < rays.size() && can_be_traced(rays[lane]);
        valid[lane] = used ? -1 : 0;
        const SceneRay& ray = used ? rays[lane] : unused;
        packet.org_x[lane] = static_cast<float>(ray.origin.x());
        packet.org_y[lane] = static_cast<float>(ray.origin.y());
        packet.org_z[lane] = static_cast<float>(ray.origin.z());
        packet.dir_x[lane] = static_cast<float>(ray.direction.x());
        packet.dir_y[lane] = static_cast<float>(ray.direction.y());
        packet.dir_z[lane] = static_cast<float>(ray.direction.z());
        packet.tnear[lane] = 0;
        packet.tfar[lane] = farthest;
        packet.time[lane] = 0;
        packet.mask[lane] = ~0U;
        packet.id[lane] = 0;
        packet.flags[lane] = 0;
    }
}

/// Fills Embree's buffers; false when it has no memory for them.
bool fill(RTCGeometry geometry, std::span<const Eigen::Vector3d> vertices, std::span<const CityTriangle> triangles) {
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), vertices.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
    if (!points || !corners) return false;
    for (const Eigen::Vector3d& vertex : vertices)
        for (const double coordinate : vertex)
            // A vertex that no kept triangle uses may be anything.
            *points++ = std::abs(coordinate) < farthest ? static_cast<float>(coordinate) : 0.0F;
    for (const CityTriangle& triangle : triangles)
        corners = std::copy_n(triangle.corners.begin(), 3, corners);
    return true;
}

const char* meaning(RTCError error) {
    switch (error) {
        case RTC_ERROR_OUT_OF_MEMORY:
            return "out of memory";
        case RTC_ERROR_UNSUPPORTED_CPU:
            return "this processor is not supported (SSE2 at least)";
        case RTC_ERROR_INVALID_ARGUMENT:
            return "invalid argument";
        case RTC_ERROR_INVALID_OPERATION:
            return "invalid operation";
        case RTC_ERROR_CANCELLED:
            return "cancelled";
        default:
            return "unknown error";
    }
}

}  // namespace

struct TriangleTree::Parts {
    /// Bytes that the device holds; Embree calls from the threads that build.
    std::atomic<std::int64_t> memory{0};
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    Parts() = default;
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;
    ~Parts() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    static bool count(void* self, ssize_t bytes, bool) {
        static_cast<Parts*>(self)->memory += bytes;
        return true;
    }
};

TriangleTree::TriangleTree(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
TriangleTree::~TriangleTree() = default;

Result<std::unique_ptr<TriangleTree>> TriangleTree::build(std::span<const Eigen::Vector3d> vertices,
                                                          std::span<const CityTriangle> triangles) {
    auto parts = std::make_unique<Parts>();
    parts->device = rtcNewDevice("threads=1");
    const auto refused = [&parts] {
        const RTCError error = rtcGetDeviceError(parts->device);
        return fail(ErrorCode::outside, fmt::format("Embree cannot build the city: {}", meaning(error)));
    };
    if (!parts->device) return refused();
    rtcSetDeviceMemoryMonitorFunction(parts->device, Parts::count, parts.get());
    parts->scene = rtcNewScene(parts->device);
    // Robust: no ray slips between two triangles. Without compact: see Query.
    rtcSetSceneFlags(parts->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(parts->scene, RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(parts->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Woods alone have no triangle: the scene stays empty.
    if (triangles.empty()) {
        rtcCommitScene(parts->scene);
    } else if (fill(geometry, vertices, triangles)) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(parts->scene, geometry);
        rtcCommitScene(parts->scene);
    }
    rtcReleaseGeometry(geometry);
    const RTCError error = rtcGetDeviceError(parts->device);
    if (error != RTC_ERROR_NONE)
        return fail(ErrorCode::outside, fmt::format("Embree cannot build the city: {}", meaning(error)));
    return std::unique_ptr<TriangleTree>(new TriangleTree(std::move(parts)));
}

bool TriangleTree::occluded(const SceneRay& ray, float length) const {
    if (!can_be_traced(ray)) return false;
    RTCRay query;
    set_ray(query, ray, 0, length);
    Query::occluded(parts_->scene, query);
    return query.tfar < 0;
}

void TriangleTree::occluded(std::span<const SceneRay> rays, std::span<std::uint8_t> answers) const {
    alignas(64) int valid[width];
    RTCRay16 packet;
    set_rays(packet, valid, rays);
    Query::occluded(valid, parts_->scene, packet);
    for (std::size_t lane = 0; lane < rays.size(); ++lane)
        answers[lane] = packet.tfar[lane] < 0;
}

TreeHit TriangleTree::nearest(const SceneRay& ray, float from) const {
    if (!can_be_traced(ray)) return {};
    RTCRayHit query;
    set_ray(query.ray, ray, from, farthest);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    Query(false).nearest(parts_->scene, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.hit.primID, query.ray.tfar};
}

std::array<TreeHit, TriangleTree::width> TriangleTree::nearest(std::span<const SceneRay> rays, bool coherent) const {
    alignas(64) int valid[width];
    RTCRayHit16 packet;
    set_rays(packet.ray, valid, rays);
    for (std::size_t lane = 0; lane < width; ++lane) {
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    Query(coherent).nearest(valid, parts_->scene, packet);
    std::array<TreeHit, width> hits;
    for (std::size_t lane = 0; lane < rays.size(); ++lane)
        if (packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID)
            hits[lane] = {packet.hit.primID[lane], packet.ray.tfar[lane]};
    return hits;
}

std::size_t TriangleTree::memory() const { return static_cast<std::size_t>(parts_->memory.load()); }

}  // namespace skyloop::inline world
