#pragma once

#include "core/job/field_writer.h"

/// The lines of the parts of a job in resolved_job_text.
namespace hyades::core {

void write_light(FieldWriter& out, const LightDesc& light);
void write_material(FieldWriter& out, const MaterialDesc& material);
void write_medium(FieldWriter& out, const MediumDesc& medium);
void write_object(FieldWriter& out, const ObjectDesc& object);
void write_texture(FieldWriter& out, const TextureDesc& texture);

}  // namespace hyades::core
