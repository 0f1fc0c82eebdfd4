// Every wrong scene stops with one line: file:line:column: what. One row each.
#include "scene_text.h"

#define LIGHT "LightSource \"point\"\n"
#define SPHERE "Shape \"sphere\"\n"
#define W "WorldBegin\n"
#define HAZE "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" "
#define GRID "MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" "
#define FOG "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1]\n"
#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] "

static const struct {
  const char *text;
  int line, column;
  const char *words; // must be part of the message
} cases[] = {
    // tokens
    {W "Shape \"sphere", 2, 7, "no closing quote"},
    {W "Shape \"sphere\n\"", 2, 7, "no closing quote"},
    {W "Shape \"sph\\ere\"", 2, 12, "escape"},
    {W "Shape \"sphere\" \"float radius\" [1", 2, 31, "this [ has no ]"},
    {W "Shape \"sphere\" \"float radius\" [0x10]", 2, 32, "0x10 is not a number"},
    {W "Shape \"sphere\" \"float radius\" [1.2.3]", 2, 32, "not a number"},
    {W "Shape \"sphere\" \"float radius\" [1e400]", 2, 32, "too large"},
    {W "Shape \"sphere\" \"float radius\" [-1e400]", 2, 32, "too large"},
    {W "Shape \"sphere\" \"float radius\" nan", 2, 31, "expected a number, found nan"},
    {W "Shape \"sphere\" \"float radius\" [inf]", 2, 32, "expected a number, found inf"},
    {W "Shape \"sphere\" \x01", 2, 16, "unexpected byte 0x01"},
    {W "\xef\xbb\xbf", 2, 1, "unexpected byte 0xef"},
    // directives
    {W "Shpae \"sphere\"", 2, 1, "did you mean Shape?"},
    {W "Frobnicate", 2, 1, "unknown directive Frobnicate"},
    {W "WorldEnd", 2, 1, "take it out"},
    {W "Include \"no-such.pbrt\"", 2, 1, "Include: no-such.pbrt: cannot open it"},
    {W "Include no-such.pbrt", 2, 9, "expected a name in quotes"},
    {"Import \"a.pbrt\"", 1, 1, "Import must come after WorldBegin"},
    {W "3", 2, 1, "expected a directive, found 3"},
    {W SPHERE "]", 3, 1, "expected a directive"},
    {"Translate 1 2 3 4 " W, 1, 17, "expected a directive, found 4"},
    {"Translate 1 2 " W, 1, 15, "number 3 of 3, found WorldBegin"},
    {"LookAt 0 0 0  0 0 1  0 1", 1, 25, "the end of the file"},
    {"Transform 1 0 0 0", 1, 11, "expected [ and 16 numbers"},
    {"Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0]", 1, 41, "number 16 of 16"},
    {"Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 7]", 1, 44, "expected ], found 7"},
    {"Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]", 1, 1, "0 0 0 1"},
    {"Scale 1 0 1", 1, 1, "singular"},
    {"Scale 1e200 1e200 1e200\nScale 1e200 1e200 1e200", 1, 1, "singular"},
    {"Translate 1e308 0 0\nTranslate 1e308 0 0", 2, 1, "overflows"},
    {"ConcatTransform [1 2 3 0 2 4 6 0 0 0 1 0 0 0 0 1]", 1, 1, "singular"},
    {"Rotate 30 0 0 0", 1, 1, "axis has no length"},
    {"LookAt 1 2 3  1 2 3  0 1 0", 1, 1, "LookAt"},
    {"LookAt 1 2 3  1 5 3  0 1 0", 1, 1, "LookAt"},
    {"ActiveTransform Middle", 1, 17, "expected StartTime, EndTime or All, found Middle"},
    {"ActiveTransform \"All\"", 1, 17, "expected a word"},
    {"TransformTimes 1 1", 1, 1, "the start must be before the end"},
    {"TransformTimes 0", 1, 17, "number 2 of 2"},
    {W "TransformTimes 0 1", 2, 1, "must come before WorldBegin"},
    {"CoordSysTransform \"camera\"", 1, 19, "unknown coordinate system \"camera\"; there are none"},
    {"CoordinateSystem \"stage\" CoordSysTransform \"stagr\"", 1, 44, "did you mean \"stage\"?"},
    {W "CoordSysTransform \"x\"", 2, 19, "; there are \"world\""},
    {"ActiveTransform EndTime Scale 1 0 1", 1, 25, "singular"},
    {"Option \"seed\"", 1, 14, "expected a value, found the end of the file"},
    {"Option \"seed\" true", 1, 15, "expected a number, found true"},
    {"Option \"seed\" -1", 1, 15, "expected an integer from 0"},
    {"Option \"seed\" 1.5", 1, 15, "expected an integer from 0"},
    {"Option \"sed\" 1", 1, 8, "did you mean \"seed\"?"},
    {"Option \"gpu\" true", 1, 8, "unknown option \"gpu\""},
    {"Option \"pixelstats\" 1", 1, 21, "expected true or false, found 1"},
    {"Option \"pixelstats\" [true", 1, 26, "expected ], found the end of the file"},
    {"Option \"forcediffuse\" true", 1, 1, "changes every material"},
    // the order of things
    {SPHERE, 1, 1, "Shape must come after WorldBegin"},
    {LIGHT, 1, 1, "must come after WorldBegin"},
    {W "Camera \"perspective\"", 2, 1, "Camera must come before WorldBegin (line 1)"},
    {W W, 2, 1, "WorldBegin must come before WorldBegin"},
    {"Film \"rgb\"\n", 2, 1, "no WorldBegin"},
    {"", 1, 1, "no WorldBegin"},
    {"# only a comment", 1, 17, "no WorldBegin"},
    {W LIGHT, 3, 1, "no Shape"},
    {W "AttributeEnd", 2, 1, "AttributeEnd without AttributeBegin"},
    {W "AttributeBegin\n AttributeBegin " SPHERE "AttributeEnd\n" LIGHT, 2, 1,
     "has no AttributeEnd"},
    // materials, textures, media
    {W "NamedMaterial \"a\"\n" SPHERE, 2, 15, "unknown material \"a\"; there are none yet"},
    {W "NamedMaterial \"wod\" MakeNamedMaterial \"wood\" \"string type\" \"diffuse\"\n" SPHERE, 2,
     15, "did you mean \"wood\"?"},
    {W "MakeNamedMaterial \"a\"", 2, 1, "\"string type\" is missing"},
    {W "MakeNamedMaterial \"a\" \"float type\" 1", 2, 23, "must be of type string"},
    {W "MakeNamedMaterial \"a\" \"string type\" \"difuse\"", 2, 23, "did you mean \"diffuse\"?"},
    {W "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"a\"", 3, 19,
     "already defined"},
    {W "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"float eta\" 2", 2, 47,
     "does not read a parameter \"eta\""},
    {W "Material \"diffuse\" \"texture displacement\" \"d\"", 2, 20, "--lenient leaves it out"},
    {W "Material \"diffuse\" \"string normalmap\" \"n.png\"", 2, 20, "--lenient leaves it out"},
    {W "Shape \"sphere\" \"texture displacement\" \"d\"", 2, 16, "--lenient leaves it out"},
    {W "Texture \"a\" \"color\" \"constant\"", 2, 13, "\"float\" or \"spectrum\", not \"color\""},
    {W "Texture \"a\" \"float\"", 2, 20, "expected a name in quotes"},
    {W "Texture \"a\" \"float\" \"imagmap\"", 2, 21, "not in this version"},
    {W "Shape \"sphere\" \"texture alpha\" \"a\"", 2, 16, "there is no texture \"a\""},
    {W "Shape \"sphere\" \"rgb alpha\" [1 1 1]", 2, 16, "must be of type float"},
    {W "MakeNamedMedium \"a\"", 2, 1, "\"string type\" is missing"},
    {W "MakeNamedMedium \"a\" \"string type\" \"fog\"", 2, 21, "unknown medium \"fog\""},
    {W "MakeNamedMedium \"a\" \"string type\" \"homogenous\"", 2, 21,
     "did you mean \"homogeneous\"?"},
    {W "MakeNamedMedium \"a\" \"string type\" \"cloud\"", 2, 21,
     "a medium \"cloud\" is not in this version"},
    {W FOG "MakeNamedMedium \"fog\"", 3, 17, "already defined"},
    {W HAZE "\"float g\" [1]", 2, 49, "\"g\" must be between -1 and 1"},
    {W HAZE "\"float g\" [-1]", 2, 49, "\"g\" must be between -1 and 1"},
    {W HAZE "\"float scale\" [-1]", 2, 49, "\"scale\" must not be negative"},
    {W HAZE "\"rgb sigma_s\" [1 -1 1]", 2, 49, "\"sigma_s\" must not be negative"},
    {W HAZE "\"rgb sigma_a\" [1e200 1 1] \"float scale\" 1e200", 2, 75, "too large"},
    {W HAZE "\"float scale\" 1e-309", 2, 49, "too small, but not 0"},
    {W HAZE "\"float Lescale\" [-1]", 2, 49, "\"Lescale\" must not be negative"},
    {W HAZE "\"float phase\" [1]", 2, 49, "phase"},
    {W HAZE "\"string preset\" \"skimmilk\"", 2, 49, "did you mean \"Skimmilk\"?"},
    {W HAZE "\"string preset\" \"Cream\" \"rgb sigma_a\" [1 1 1]", 2, 73, "sigma_a"},
    {W GRID, 2, 1, "\"float density\" is missing"},
    {W GRID "\"rgb density\" [1 1 1]", 2, 49, "density"},
    {W GRID "\"float density\" [1 2]", 2, 49, "has 2 samples, and nx * ny * nz is 1"},
    {W GRID "\"float density\" [-1]", 2, 49, "must not be negative"},
    {W GRID "\"float density\" [1e39]", 2, 49, "fit into floats"},
    {W GRID "\"float density\" 1 \"float Lescale\" [1 2]", 2, 67, "\"Lescale\" has 2 samples"},
    {W GRID "\"integer nx\" 0 \"float density\" 1", 2, 49, "\"nx\" must be at least 1"},
    {W GRID "\"integer nx\" 65536 \"integer nz\" 65536", 2, 68, "more than 2^30 samples"},
    {W GRID "\"float density\" 1 \"point3 p1\" [1 1 0]", 2, 67, "the grid's box is flat"},
    {W GRID "\"float density\" 1 \"float temperature\" 1", 2, 67, "\"temperature\" is not in"},
    {W GRID "\"float density\" 1e38 \"rgb sigma_a\" [1e290 1 1]", 2, 49, "too large"},
    {W "ActiveTransform EndTime Translate 1 0 0\n" GRID "\"float density\" 1", 3, 1,
     "a medium cannot move"},
    {W FOG "MediumInterface \"fgo\" \"\"\n" SPHERE, 4, 1, "did you mean \"fog\"?"},
    {W FOG "MediumInterface \"\" \"fig\"\n" SPHERE, 4, 1,
     "Shape \"sphere\": unknown medium \"fig\"; did you mean \"fog\"?"},
    {W FOG "MediumInterface \"fig\" \"fig\"\n" SPHERE, 4, 1, "unknown medium \"fig\""},
    {W FOG "MediumInterface \"fig\"\n" LIGHT, 4, 1,
     "LightSource \"point\": unknown medium \"fig\""},
    {W FOG "MediumInterface \"fog\" \"\"\nMaterial \"interface\"\n"
           "Shape \"sphere\" \"float alpha\" 0.5",
     5, 16, "an interface between media has no holes"},
    {FOG "MediumInterface \"fig\"\n Camera \"perspective\"", 3, 2,
     "Camera \"perspective\": unknown medium \"fig\""},
    // the order of things
    {W "TransformBegin", 2, 1, "this TransformBegin has no TransformEnd"},
    {W "ObjectBegin \"a\"\n AttributeBegin\n ObjectEnd", 4, 2,
     "ObjectEnd: the AttributeBegin in line 3 is to be ended first"},
    {W "AttributeBegin\nObjectBegin \"a\"\nAttributeEnd", 4, 1, "the ObjectBegin in line 3"},
    {W "ObjectBegin \"a\"", 2, 1, "this ObjectBegin has no ObjectEnd"},
    {W "ObjectEnd", 2, 1, "ObjectEnd without ObjectBegin"},
    {W "ObjectBegin \"a\" ObjectBegin \"b\"", 2, 17, "within an object's definition"},
    {W "ObjectBegin \"a\" ObjectInstance \"a\"", 2, 17, "within an object's definition"},
    {W "ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\"", 3, 13, "already defined"},
    {W "ObjectBegin \"block\" ObjectEnd\nObjectInstance \"blok\"", 3, 16,
     "did you mean \"block\"?"},
    {W "AreaLightSource \"diffuse\" ObjectBegin \"a\"\n" SPHERE, 3, 1, "does not shine"},
    {W "ObjectBegin \"a\" Shape \"sphere\" \"float radius\" -1 ObjectEnd\n" SPHERE, 2, 32,
     "radius must be positive"},
    {W "Scale 1e-60 1e-60 1e-60\nObjectBegin \"a\" " SPHERE "ObjectEnd\n ObjectInstance \"a\"", 5,
     2, "overflows or flattens"},
    {W "ActiveTransform EndTime Translate 1 0 0 AreaLightSource \"diffuse\"\n" SPHERE, 3, 1,
     "an area light cannot move"},
    {W "Attribute \"shapes\" \"float radius\" 1", 2, 11, "did you mean shape?"},
    {W "Attribute \"shape\" \"float radius\" -1\n" SPHERE, 2, 19, "radius must be positive"},
    {W "Attribute \"shape\" \"float radius\" 1\nShape \"sphere\" \"float phi\" 1", 3, 16,
     "does not read a parameter \"phi\""},
    {"Film \"rgb\"\nFilm \"rgb\"", 2, 1, "a second Film (the first is in line 1)"},
    {"Camera \"perspective\" Camera \"perspective\"", 1, 22, "a second Camera"},
    // names of types
    {W "Shape sphere", 2, 7, "expected a name in quotes, found sphere"},
    {W "Shape \"spere\"", 2, 7, "did you mean \"sphere\"?"},
    {W "Shape \"hyperboloid\"", 2, 7, "\"hyperboloid\" is not in this version"},
    {W "Material \"velvet\"", 2, 10, "\"velvet\" is not in this version"},
    {W "Material \"hair\"", 2, 10, "\"conductor\" comes nearest"},
    {W "Material \"conductor\" \"float roughness\" -1", 2, 22, "must be in [0, 1e6], and is -1"},
    {W "Material \"conductor\" \"rgb k\" [3 1e200 3]", 2, 22,
     "must not exceed 1e6, and has 1e+200"},
    {W "Material \"conductor\" \"rgb k\" [1 2 3] \"rgb reflectance\" [1 1 1]", 2, 38,
     "give either"},
    {W "Material \"dielectric\" \"float eta\" 0", 2, 23, "must be in [0.001, 1000], and is 0"},
    {W "Material \"diffusetransmission\" \"rgb transmittance\" [1 0 .5] \"float scale\" 2", 2, 32,
     "must not exceed 1, and is 2"},
    {W "LightSource \"infinit\"", 2, 13, "did you mean \"infinite\"?"},
    {W "LightSource \"diffuse\"", 2, 13, "not in this version"},
    {W "AreaLightSource \"point\"", 2, 17, "not in this version"},
    {"Camera \"realistic\"", 1, 8, "use \"perspective\""},
    {"Film \"gbuffer\"", 1, 6, "use \"rgb\""},
    {"PixelFilter \"mitchell\"", 1, 13, "use \"gaussian\""},
    {"Sampler \"best\"", 1, 9, "use \"independent\""},
    {"ColorSpace \"aces2065-1\"", 1, 12, "use \"srgb\""},
    // parameters
    {W "Shape \"sphere\" \"radius\" 1", 2, 16, "expected a parameter as \"type name\""},
    {W "Shape \"sphere\" \"float radius big\" 1", 2, 16, "\"type name\""},
    {W "Shape \"sphere\" \"flaot radius\" 1", 2, 16, "did you mean \"float\"?"},
    {W "Shape \"sphere\" \"color radius\" 1", 2, 16, "use \"rgb\""},
    {W "Shape \"sphere\" \"float raduis\" 1", 2, 16, "did you mean \"radius\"?"},
    {W "Shape \"sphere\" \"float colour\" 1", 2, 16, "it reads radius, phimax, zmin, zmax"},
    {W "Shape \"sphere\" \"float radius\"", 2, 30, "expected a number, found the end of the file"},
    {W "Shape \"sphere\" \"float radius\" []", 2, 16, "has no value"},
    {W "Shape \"sphere\" \"float radius\" [1 2]", 2, 16, "needs 1 value, has 2"},
    {W "Shape \"sphere\" \"float radius\" [[1]]", 2, 32, "expected a number, found ["},
    {W "Shape \"sphere\" \"float radius\" \"1\"", 2, 31, "expected a number"},
    {W "Shape \"sphere\" \"integer radius\" 1", 2, 16, "must be of type float, not integer"},
    {W "Shape \"sphere\" \"float radius\" 1\n\"float radius\" 2", 3, 1, "already given at line 2"},
    {W "Shape \"sphere\" \"string alpha\" 1", 2, 31, "expected a string"},
    {"Film \"rgb\" \"bool savefp16\" yes", 1, 28, "expected true or false"},
    {"Film \"rgb\" \"integer xresolution\" 1.5", 1, 34, "expected an integer, found 1.5"},
    {W "Material \"diffuse\" \"spectrum reflectance\" [400 1 \"a\"]", 2, 20, "mixes"},
    {W "Material \"diffuse\" \"rgb reflectance\" [.5 .5]", 2, 20, "groups of 3"},
    {W "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5 .5 .5 .5]", 2, 20, "needs 3 values"},
    // values
    {W "Material \"diffuse\" \"rgb reflectance\" [.5 1.01 .5]", 2, 20, "must be in [0, 1]"},
    {W "Material \"diffuse\" \"rgb reflectance\" [.5 -.1 .5]", 2, 20, "must be in [0, 1]"},
    {W "Material \"diffuse\" \"spectrum reflectance\" \"wood\"", 2, 20, "there is no spectrum"},
    {W "Material \"diffuse\" \"texture reflectance\" \"wood\"", 2, 20, "no texture"},
    {"Camera \"perspective\" \"float fov\" 180", 1, 22, "between 0 and 180"},
    {"Camera \"perspective\" \"float fov\" 0", 1, 22, "between 0 and 180"},
    {"Camera \"perspective\" \"float lensradius\" -.1", 1, 22, "must not be negative"},
    {"Camera \"perspective\" \"float focaldistance\" 0", 1, 22, "must be positive"},
    {"Camera \"perspective\" \"float shutteropen\" 1", 1, 1, "the shutter is never open"},
    {"Camera \"perspective\" \"float screenwindow\" [-1 1 -1]", 1, 22, "needs 4 numbers, has 3"},
    {"Camera \"perspective\" \"float screenwindow\" [-1 1 1 1]", 1, 22, "no area"},
    {"Camera \"perspective\" \"float frameaspectratio\" -1", 1, 22, "must be positive"},
    {"Camera \"orthographic\" \"float fov\" 60", 1, 23, "fov"},
    {"Camera \"spherical\" \"float lensradius\" 1", 1, 20, "lensradius"},
    {"Camera \"spherical\" \"string mapping\" \"flat\"", 1, 20, "\"equalarea\""},
    {W "ActiveTransform EndTime Scale 1e38 1e38 1e38\n" SPHERE "Translate 9 0 0 " SPHERE, 4, 17,
     "moves out of the range of floats"},
    {W "ActiveTransform EndTime Translate 1e300 -1e300 1e300\n" SPHERE, 3, 1,
     "moves out of the range of floats"},
    {"Film \"rgb\" \"float cropwindow\" [0 .5 0 1.1]", 1, 12, "in [0, 1]"},
    {"Film \"rgb\" \"float cropwindow\" [.5 .5 0 1]", 1, 12, "at least a pixel"},
    {"Film \"rgb\" \"integer pixelbounds\" [0 1281 0 1]", 1, 12, "x1 <= xresolution"},
    {"Film \"rgb\" \"integer pixelbounds\" [0 5 0 5] \"float cropwindow\" [0 1 0 1]", 1, 44,
     "give one"},
    {"Film \"rgb\" \"string sensor\" \"canon_eos_100d\"", 1, 12, "--lenient leaves it out"},
    {"Film \"rgb\" \"float whitebalance\" 5000", 1, 12, "--lenient leaves it out"},
    {"Film \"rgb\" \"float maxcomponentvalue\" 10", 1, 12, "--lenient leaves it out"},
    {"Film \"rgb\" \"float iso\" 0", 1, 12, "iso must be positive"},
    {"PixelFilter \"gaussian\" \"float sigma\" -1", 1, 24, "sigma must be positive"},
    {"PixelFilter \"gaussian\" \"float sigma\" 1e9", 1, 24, "1000 times the radius"},
    {"PixelFilter \"triangle\" \"float tau\" 3", 1, 24, "tau"},
    {"Film \"rgb\" \"integer xresolution\" 0", 1, 12, "from 1 to 65536"},
    {"Film \"rgb\" \"integer yresolution\" -3", 1, 12, "from 1 to 65536"},
    {"Film \"rgb\" \"integer yresolution\" 4294967297", 1, 12, "from 1 to 65536"},
    {"PixelFilter \"box\" \"float xradius\" 0", 1, 19, "must be positive"},
    {"Sampler \"independent\" \"integer pixelsamples\" 0", 1, 23, "at least 1"},
    {"Sampler \"stratified\" \"bool jitter\" false", 1, 22, "must be 1: the pixel's centre"},
    {"Sampler \"independent\" \"integer seed\" -7", 1, 23, "seed must be at least 0"},
    {"Sampler \"independent\" \"integer seed\" -1", 1, 23, "seed must be at least 0"},
    {"Integrator \"path\" \"bool regularize\" true", 1, 19, "must be false"},
    {"Integrator \"path\" \"integer maxdepth\" -1", 1, 19, "maxdepth"},
    {"Integrator \"probabilistic\" \"float radius\" 0", 1, 28, "must be positive"},
    {"Integrator \"probabilistic\" \"float alpha\" 1.5", 1, 28, "alpha must be in [0, 1]"},
    {"Integrator \"probabilistic\" \"integer photons\" 0", 1, 28, "must be at least 1"},
    {"Integrator \"probabilistic\" \"integer photons\" 5 \"integer photonsperiteration\" 6", 1, 28,
     "give one"},
    {"Integrator \"probabilistic\" \"string direct\" \"both\"", 1, 28, "\"photons\" or \"nee\""},
    {"Integrator \"probabilistic\" \"float alhpa\" .5", 1, 28, "did you mean \"alpha\"?"},
    // shapes
    {W "Shape \"sphere\" \"float radius\" 0", 2, 16, "radius must be positive"},
    {W "Shape \"sphere\" \"float zmin\" -2", 2, 16, "zmin must be in"},
    {W "Shape \"sphere\" \"float zmax\" 1.5", 2, 16, "zmax must be in"},
    {W "Shape \"sphere\" \"float zmin\" .5 \"float zmax\" .25", 2, 32, "zmax must be in"},
    {W "Shape \"disk\" \"float phimax\" 400", 2, 14, "phimax must be in"},
    {W "Shape \"disk\" \"float innerradius\" 1", 2, 14, "innerradius must be in"},
    {W "Scale 1e30 1e30 1e30 Translate 1e10 0 0\n" SPHERE, 3, 1, "does not fit into floats"},
    {W "Shape \"trianglemesh\"", 2, 1, "\"point3 P\" is missing"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]", 2, 22,
     "indices\" is missing"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1]", 2, 22, "groups of 3"},
    {W TRIANGLE "\"integer indices\" [0 1]", 2, 53, "not a multiple of 3"},
    {W TRIANGLE "\"integer indices\" [0 1 3]", 2, 53,
     "index number 3 is 3, but the vertices are 0 to 2"},
    {W TRIANGLE "\"integer indices\" [0 -1 2]", 2, 53, "index number 2 is -1"},
    {W TRIANGLE "\"integer indices\" [0 1 4294967296]", 2, 53, "is 4294967296"},
    {W TRIANGLE "\"normal N\" [0 0 1 0 0 1]", 2, 53, "2 values of \"N\" for 3 vertices"},
    {W TRIANGLE "\"point2 uv\" [0 0 1 0]", 2, 53, "2 values of \"uv\" for 3 vertices"},
    {W TRIANGLE "\"point2 uv\" [0 0 1 0 0 1e39]", 2, 53, "uv of vertex 2 is too large"},
    {W TRIANGLE "\"vector3 S\" [0 0 1]", 2, 53, "1 values of \"S\" for 3 vertices"},
    {W "Shape \"bilinearmesh\"", 2, 1, "\"point3 P\" is missing"},
    {W "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]", 2, 22, "indices\" is missing"},
    {W "Shape \"bilinearmesh\" \"point3 P\" [0 0 0] \"integer indices\" [0 0 0]", 2, 41,
     "3 indices are not a multiple of 4"},
    {W "Shape \"cylinder\" \"float zmin\" 1", 2, 1, "zmin and zmax are equal"},
    {W "Shape \"loopsubdiv\" \"integer levels\" -1 \"point3 P\" [0 0 0 1 0 0 0 1 0]", 2, 20,
     "levels must be 0 to 15"},
    {W "Shape \"loopsubdiv\" \"string scheme\" \"x\" \"point3 P\" [0 0 0 1 0 0 0 1 0]", 2, 20,
     "the only scheme is"},
    {W "Shape \"loopsubdiv\" \"point3 P\" [0 0 0 1 0 0] \"integer indices\" [0 1 1]", 2, 45,
     "triangle 0 has vertex 1 twice"},
    {W "Shape \"plymesh\"", 2, 1, "\"string filename\" is missing"},
    {W "Shape \"plymesh\" \"string filename\" \"m.ply\"", 2, 17, "m.ply: cannot open it"},
    {W "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1e39 0]", 2, 22, "vertex 2 is too far"},
    {W "Scale 1e20 1e20 1e20 Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1e19 0]", 2, 43,
     "vertex 2 is too far"},
    // lights
    {W "LightSource \"point\" \"rgb I\" [0 0 0]\n" SPHERE, 2, 1, "no light emits anything"},
    {W "LightSource \"point\" \"rgb I\" [1e308 1e308 1e308] \"float scale\" 1e10\n" SPHERE, 2, 49,
     "finite"},
    {W "LightSource \"point\" \"rgb J\" [1 1 1]\n" SPHERE, 2, 21,
     "does not read a parameter \"J\""},
};
enum { N_CASES = (int)(sizeof cases / sizeof *cases) };

static bool is_one_line(const char *text) {
  for (; *text; text++)
    if ((unsigned char)*text < 0x20) return false;
  return true;
}

static bool check_case(int i) {
  struct scene scene;
  struct problem problem;
  char place[64];
  snprintf(place, sizeof place, "t.pbrt:%d:%d: ", cases[i].line, cases[i].column);
  bool accepted = scene_of_bytes(cases[i].text, (ptrdiff_t)strlen(cases[i].text), &scene, &problem);
  if (!accepted && strncmp(problem.text, place, strlen(place)) == 0 &&
      strstr(problem.text, cases[i].words) && is_one_line(problem.text))
    return true;
  print_error("%s\ngives    %s\nwanted   %s%s\n", cases[i].text, problem.text, place,
              cases[i].words);
  return false;
}

static void every_wrong_scene_gives_one_line_with_its_place(void **state) {
  (void)state;
  int wrong = 0;
  for (int i = 0; i < N_CASES; i++) wrong += !check_case(i);
  assert_int_equal(wrong, 0);
}

static void a_zero_byte_is_a_problem(void **state) {
  (void)state;
  struct scene scene;
  struct problem problem;
  assert_false(scene_of_bytes("WorldBegin\n\0Shape", 17, &scene, &problem));
  assert_string_equal(problem.text, "t.pbrt:2:1: unexpected byte 0x00");
}

static void a_missing_file_and_a_directory_are_problems(void **state) {
  (void)state;
  struct arena keep = test_memory()->keep;
  struct scene scene;
  struct problem problem = {{0}};
  assert_false(scene_read("tests/data/no-such-scene.pbrt", &keep, &scene, &problem));
  assert_non_null(strstr(problem.text, "no-such-scene.pbrt: "));
  problem = (struct problem){{0}};
  assert_false(scene_read("tests", &keep, &scene, &problem));
  assert_non_null(strstr(problem.text, "directory"));
}

static void a_file_on_disk_gives_its_own_name_and_place(void **state) {
  (void)state;
  struct arena keep = test_memory()->keep;
  struct scene scene;
  struct problem problem = {{0}};
  assert_false(scene_read("tests/data/scenes/unknown-directive.pbrt", &keep, &scene, &problem));
  assert_string_equal(problem.text, "tests/data/scenes/unknown-directive.pbrt:3:1: "
                                    "unknown directive Shpae; did you mean Shape?");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_wrong_scene_gives_one_line_with_its_place),
      cmocka_unit_test(a_zero_byte_is_a_problem),
      cmocka_unit_test(a_missing_file_and_a_directory_are_problems),
      cmocka_unit_test(a_file_on_disk_gives_its_own_name_and_place),
  };
  return cmocka_run_group_tests_name("scene_problems", tests, NULL, NULL);
}
