-- A chapter's page as slides: of each paragraph the first sentence; questions and exercises are whole. A slide ends with its part
-- of the page, or with a listing, a table or a picture.
local left_out = {["What changed"] = true, ["Break it"] = true, Check = true, Read = true}
local whole = {Predict = true, Exercises = true}

local function first_sentence(block)
    local kept = pandoc.Inlines({})
    for i, inline in ipairs(block.content) do
        kept:insert(inline)
        local after = block.content[i + 1]
        local ends = inline.t == "Str" and inline.text:match("[.?!]$") and not inline.text:match("^%d*%.$")
        if ends and (not after or after.t == "Space" or after.t == "SoftBreak") then break end
    end
    block.content = kept
    return block
end

function Pandoc(doc)
    local kept, title, is_full = pandoc.Blocks({}), "", false
    for _, block in ipairs(doc.blocks) do
        local text, is_picture = pandoc.utils.stringify(block), block.t == "Para" and block.content[1].t == "Image"
        if block.t == "Header" then title, is_full = text, false end
        if not left_out[title] and not text:match("^Answers:") and not text:match("^Before: ") then
            if is_full then kept:insert(pandoc.Header(2, title)) end
            is_full = is_picture or block.t == "CodeBlock" or block.t == "Table"
            kept:insert(block.t == "Para" and not whole[title] and first_sentence(block) or block)
        end
    end
    doc.blocks = kept:walk({Link = function(link) return link.content end})
    return doc
end
