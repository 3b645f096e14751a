/* Recording of passes, with the barriers their declared reads and writes call for. */
#include "pass.h"

/* One barrier for everything the library does: its passes follow each other on one queue, and finer scopes would only
 * matter between passes that could overlap, of which there are none. */
static void barrier(softshi_recorder *r)
{
    const VkMemoryBarrier memory = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_UNIFORM_READ_BIT |
                         VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                         VK_ACCESS_TRANSFER_WRITE_BIT,
    };
    r->context->vk.CmdPipelineBarrier(
        r->cmd,
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, 0,
        1, &memory, 0, NULL, 0, NULL);
    r->read = r->written = 0;
}

static void order(softshi_recorder *r, uint32_t reads, uint32_t writes)
{
    if ((r->written & (reads | writes)) || (r->read & writes))
        barrier(r);
    r->read |= reads;
    r->written |= writes;
}

static void timestamp(softshi_recorder *r, const char *name)
{
    softsh_timestamps *t = r->timestamps;
    if (!t)
        return;
    uint32_t query = t->first_query;
    if (name) {
        if (t->pass_count >= SOFTSH_MAX_PASSES)
            return;
        t->pass_names[t->pass_count++] = name;
        query += t->pass_count;
    }
    r->context->vk.CmdWriteTimestamp(r->cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, t->pool, query);
}

static void begin_label(const softshi_recorder *r, const char *name)
{
    if (!r->context->vk.CmdBeginDebugUtilsLabelEXT)
        return;
    const VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name};
    r->context->vk.CmdBeginDebugUtilsLabelEXT(r->cmd, &label);
}

static void end_label(const softshi_recorder *r)
{
    if (r->context->vk.CmdEndDebugUtilsLabelEXT)
        r->context->vk.CmdEndDebugUtilsLabelEXT(r->cmd);
}

void softshi_record_begin(softshi_recorder *recorder, const softsh_context *context, VkCommandBuffer cmd,
                          softsh_timestamps *timestamps, const char *label)
{
    *recorder = (softshi_recorder){.context = context, .cmd = cmd, .timestamps = timestamps};
    begin_label(recorder, label);
    if (timestamps)
        timestamps->pass_count = 0;
    timestamp(recorder, NULL);
    barrier(recorder);
}

void softshi_record_end(softshi_recorder *recorder)
{
    end_label(recorder);
}

void softshi_record_pass(softshi_recorder *recorder, const softshi_pass *pass)
{
    const softsh_context *context = recorder->context;
    order(recorder, pass->reads, pass->writes);
    begin_label(recorder, pass->pipeline->name);
    context->vk.CmdBindPipeline(recorder->cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pass->pipeline->handle);
    context->vk.CmdBindDescriptorSets(recorder->cmd, VK_PIPELINE_BIND_POINT_COMPUTE, context->pipeline_layout, 0, 2,
                                      recorder->sets, 0, NULL);
    if (pass->push)
        context->vk.CmdPushConstants(recorder->cmd, context->pipeline_layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                     pass->push_size, pass->push);
    if (pass->indirect)
        context->vk.CmdDispatchIndirect(recorder->cmd, pass->indirect, pass->indirect_offset);
    else
        context->vk.CmdDispatch(recorder->cmd, pass->groups[0], pass->groups[1], pass->groups[2]);
    end_label(recorder);
    timestamp(recorder, pass->pipeline->name);
}

void softshi_record_update(softshi_recorder *recorder, uint32_t writes, VkBuffer buffer, VkDeviceSize offset,
                           const void *data, VkDeviceSize size)
{
    order(recorder, 0, writes);
    recorder->context->vk.CmdUpdateBuffer(recorder->cmd, buffer, offset, size, data);
}

void softshi_record_clear(softshi_recorder *recorder, uint32_t writes, VkBuffer buffer, VkDeviceSize offset,
                          VkDeviceSize size)
{
    order(recorder, 0, writes);
    recorder->context->vk.CmdFillBuffer(recorder->cmd, buffer, offset, size, 0);
}

void softshi_record_copy(softshi_recorder *recorder, uint32_t reads, VkBuffer from, VkDeviceSize from_offset,
                         VkBuffer to, VkDeviceSize to_offset, VkDeviceSize size)
{
    order(recorder, reads, 0);
    const VkBufferCopy region = {from_offset, to_offset, size};
    recorder->context->vk.CmdCopyBuffer(recorder->cmd, from, to, 1, &region);
}

void softshi_record_release(softshi_recorder *recorder)
{
    if (recorder->written)
        barrier(recorder);
}
