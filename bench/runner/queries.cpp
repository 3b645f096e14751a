// Timestamps of one recording.
#include "queries.hpp"

#include "error.hpp"

Queries::Queries(gpu &g, uint32_t count) : gpu_(g), count_(count)
{
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = count;
    if (vkCreateQueryPool(g.device, &info, nullptr, &pool) != VK_SUCCESS)
        fail("vkCreateQueryPool failed");
}

Queries::~Queries()
{
    vkDestroyQueryPool(gpu_.device, pool, nullptr);
}

void Queries::reset(VkCommandBuffer cmd)
{
    vkCmdResetQueryPool(cmd, pool, 0, count_);
}

void Queries::write(VkCommandBuffer cmd, uint32_t i, bool hold_back)
{
    vkCmdWriteTimestamp(cmd, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool, i);
    if (hold_back)
        vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr,
                             0, nullptr, 0, nullptr);
}

std::vector<double> Queries::differences(uint32_t first, uint32_t n)
{
    std::vector<uint64_t> ticks(n + 1);
    if (vkGetQueryPoolResults(gpu_.device, pool, first, n + 1, ticks.size() * sizeof(uint64_t), ticks.data(),
                              sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT) != VK_SUCCESS)
        fail("vkGetQueryPoolResults failed");
    std::vector<double> ms(n);
    for (uint32_t i = 0; i < n; i++)
        ms[i] = static_cast<double>(ticks[i + 1] - ticks[i]) * 1e-6 *
                static_cast<double>(gpu_.properties.limits.timestampPeriod);
    return ms;
}
