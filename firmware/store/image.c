/* Reading the image of a part.
   SPDX-License-Identifier: Apache-2.0 */

#include "store/image.h"
#include "store/flash.h" /* flash_address */
#include "store/parts.h" /* parts_seek */

uint16_t image_begin;

void parts_seek(uint16_t offset)
{
    flash_address = image_begin + offset;
}
