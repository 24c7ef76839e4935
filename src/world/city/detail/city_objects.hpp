/// What CityJSON and CityGML have in common: objects of surfaces in several levels of detail.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "place_on_earth.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::inline world {

/// What an object is, as far as signals care.
enum class ObjectClass {
    construction,  ///< buildings, bridges, tunnels, city furniture
    terrain,       ///< relief, roads, land use, water
    plants,        ///< PlantCover: trees when it is thick, ground when it is thin
    tree,          ///< SolitaryVegetationObject
    ignored        ///< what is inside buildings, groups
};
/// By the name of its type without prefix, in CityJSON or CityGML.
ObjectClass object_class(std::string_view type);

/// What a surface of a construction is.
enum class SurfaceUse {
    unknown,
    wall,
    roof,
    floor,
    window,
    hidden,
    by_slope  ///< untold among told ones, of a type of an extension or of none
};
/// By the name of its type without prefix; `floor` plates and what is `hidden` inside or not there are left out.
SurfaceUse surface_use(std::string_view type);

/// A plane polygon in the file's coordinates: outer ring, then holes.
struct ObjectSurface {
    std::vector<std::vector<Eigen::Vector3d>> rings;
    SurfaceUse use = SurfaceUse::unknown;
    /// Of an implicit geometry (OGC 12-019, 8.2): the rings are metres east, north and up of it.
    std::optional<Eigen::Vector3d> reference_point;
};

/// Surfaces by level of detail, times ten: "2.2" is 22.
struct CityObject {
    ObjectClass object_class = ObjectClass::construction;
    std::optional<std::size_t> parent;                 ///< of a part of a building, in the list of objects
    bool building = false;                             ///< counts as one
    std::map<int, std::vector<ObjectSurface>> levels;  ///< none is empty
};

/// A file's objects, and what could not be read of them.
struct CityObjects {
    std::vector<CityObject> objects;
    std::optional<ReferenceSystem> system;
    std::size_t dropped = 0;  ///< surfaces that are none
    std::vector<std::string> warnings;
};

/// Takes the highest level of detail of each object, places it and makes triangles: level 0 alone, which a warning
/// counts, and floor plates are left out; parts replace their whole where they tell more, and stand beside it where
/// they tell as much. Surfaces without a use are roofs when they rise by less than 60°, else walls; lowest level ones
/// of a construction are its floor. Beside ones that are told walls or roofs `unknown` ones are the same once more, as
/// a solid, and are left out.
Result<CityFile> city_of_objects(CityObjects read, std::string_view format, std::string_view name,
                                 const CityFileSettings& settings);

/// The refusal of a file with too many triangles.
tl::unexpected<Error> too_many_triangles(std::string_view name, const CityFileSettings& settings);

}  // namespace skyloop::inline world
