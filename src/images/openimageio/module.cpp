#include "images/openimageio/functions.hpp"

// The symbol that images/codec.cpp looks up.
extern "C" __attribute__((visibility("default"))) const vkfv::images::Codec vkfv_image_codec;

namespace io = vkfv::images::openimageio;

const vkfv::images::Codec vkfv_image_codec = {.page_count = io::page_count,
                                              .read_image = io::read_image,
                                              .read_channels = io::read_channels,
                                              .image_statement = io::image_statement,
                                              .parse_tiff = io::parse_tiff,
                                              .parse_image = io::parse_image,
                                              .parse_grey = io::parse_grey,
                                              .ink_of = io::ink_of,
                                              .drawn = io::drawn};
