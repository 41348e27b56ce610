/* Walks along the records of a part.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/part.h"
#include "link/protocol.h" /* image layout */
#include "store/flash.h"   /* reading numbers */
#include "store/parts.h"   /* where the image is */

uint16_t part_length;

uint16_t part_record;
uint8_t part_type;
uint8_t part_kind;
uint16_t part_size;

void part_read_record(void)
{
    parts_seek(part_record);
    part_type = flash_read();
    part_kind = flash_read();
    part_size = flash_read_u16();
}

void part_first(void)
{
    part_record = PART_IMAGE_HEADER_SIZE;
    part_read_record();
}

uint8_t part_next(void)
{
    part_record += part_size;
    if (part_record >= part_length) {
        return 0;
    }
    part_read_record();
    return 1;
}
